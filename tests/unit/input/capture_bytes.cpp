#include "tests/unit/input/capture_bytes.hpp"

namespace limn::test {

Bytes& Bytes::number(std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) {
    const int shift = 8 * (big_endian_ ? size - 1 - i : i);
    text_ += static_cast<char>(shift < 64 ? value >> shift & 0xFF : 0);
  }
  return *this;
}

std::string usbmon_packet(const Transfer& transfer, int header, bool big_endian) {
  constexpr std::uint32_t kStalled = 0xFFFFFFE0;  // -EPIPE
  Bytes out(big_endian);
  out.number(transfer.request, 8).number(transfer.completed ? 'C' : 'S', 1);
  out.number(transfer.kind, 1).number(transfer.endpoint, 1).number(transfer.device, 1);
  out.number(1, 2).number(transfer.setup.empty() ? '-' : 0, 1);
  out.number(transfer.completed ? 0 : '<', 1).number(0, 12);
  out.number(transfer.failed ? kStalled : 0, 4);
  out.number(transfer.data.size(), 4).number(transfer.data.size(), 4);
  out.text(transfer.setup.empty() ? std::string(8, '\0') : transfer.setup);
  return out.str() + std::string(static_cast<std::size_t>(header) - out.str().size(), '\0') +
         transfer.data;
}

std::string usbpcap_packet(const Transfer& transfer) {
  const bool control = transfer.kind == 2;
  Bytes out;  // low byte first whatever the file is
  out.number(control ? 28 : 27, 2).number(transfer.request, 8);
  out.number(transfer.failed ? 0xC0000004 : 0, 4).number(9, 2);
  out.number(transfer.completed ? 1 : 0, 1).number(1, 2).number(transfer.device, 2);
  out.number(transfer.endpoint, 1).number(transfer.kind, 1);
  out.number(transfer.setup.size() + transfer.data.size(), 4);
  if (control) out.number(transfer.completed ? 3 : 0, 1);
  return out.str() + transfer.setup + transfer.data;
}

CaptureFile::CaptureFile(Kind kind, int link, bool big_endian)
    : kind_(kind), big_endian_(big_endian) {
  if (kind == Kind::kPcap) {
    Bytes head(big_endian);
    head.number(0xA1B2C3D4, 4).number(2, 2).number(4, 2).number(0, 8).number(65535, 4);
    file_ = head.number(link, 4).str();
    return;
  }
  file_ = block(0x0A0D0D0A, Bytes(big_endian)
                                .number(0x1A2B3C4D, 4)
                                .number(1, 2)
                                .number(0, 2)
                                .number(~std::uint64_t{0}, 8)
                                .str());
  file_ += block(1, Bytes(big_endian).number(link, 2).number(0, 2).number(65535, 4).str());
}

std::string CaptureFile::block(std::uint32_t type, const std::string& content) const {
  const std::string padded = content + std::string((4 - content.size() % 4) % 4, '\0');
  return Bytes(big_endian_).number(type, 4).number(padded.size() + 12, 4).str() + padded +
         Bytes(big_endian_).number(padded.size() + 12, 4).str();
}

CaptureFile& CaptureFile::packet(const std::string& bytes, std::size_t left_out) {
  const std::uint64_t time = 1'000'500'000U + 1'000U * static_cast<unsigned>(count_++);  // us
  const std::string kept = bytes.substr(0, bytes.size() - left_out);
  Bytes head(big_endian_);
  if (kind_ == Kind::kPcap) {
    head.number(time / 1'000'000, 4).number(time % 1'000'000, 4);
    file_ += head.number(kept.size(), 4).number(bytes.size(), 4).str() + kept;
  } else {
    head.number(0, 4).number(time >> 32, 4).number(time & 0xFFFFFFFF, 4);
    file_ += block(6, head.number(kept.size(), 4).number(bytes.size(), 4).str() + kept);
  }
  return *this;
}

}  // namespace limn::test
