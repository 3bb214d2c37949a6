#include "modeler/app/trace_input.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "input/trace/descriptor_file.hpp"
#include "input/trace_import/trace_import.hpp"

namespace limn::app {
namespace {

/// Passes bytes through and shows how far along they are.
class ProgressBytes final : public ByteSource {
 public:
  ProgressBytes(std::unique_ptr<ByteSource> inner, std::uint64_t total)
      : inner_(std::move(inner)), total_(total) {}
  ~ProgressBytes() override {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  ProgressBytes(const ProgressBytes&) = delete;
  ProgressBytes& operator=(const ProgressBytes&) = delete;

  Expected<std::size_t> read(std::span<char> out) override {
    auto count = inner_->read(out);
    if (count) {
      done_ += *count;
      show();
    }
    return count;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{200};

  void show() {
    const auto now = Clock::now();
    if (now - last_ < kPeriod) return;  // quick reads show nothing at all
    last_ = now;
    shown_ = true;
    std::fprintf(stderr, "\rreading: %3.0f %%",
                 100.0 * static_cast<double>(done_) / static_cast<double>(total_));
  }

  std::unique_ptr<ByteSource> inner_;
  std::uint64_t total_;
  std::uint64_t done_ = 0;
  Clock::time_point last_ = Clock::now();
  bool shown_ = false;
};

std::unique_ptr<ByteSource> with_progress(const std::string& path,
                                          std::unique_ptr<ByteSource> bytes) {
  struct stat status {};
  if (::isatty(STDERR_FILENO) == 0) return bytes;
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return bytes;
  return std::make_unique<ProgressBytes>(
      std::move(bytes), static_cast<std::uint64_t>(std::max<off_t>(1, status.st_size)));
}

using Open = Expected<std::unique_ptr<TraceReader>>(std::unique_ptr<ByteSource>, TraceOptions);

tl::expected<std::unique_ptr<TraceReader>, Failure> open_input(const TraceArguments& arguments,
                                                               Open* open, bool shows_progress) {
  TraceOptions options;
  options.salvage = arguments.salvage;
  options.supplied.vendor = arguments.vendor;
  options.supplied.product = arguments.product;
  if (!arguments.descriptor_path.empty()) {
    auto descriptors = in_file(arguments.descriptor_path,
                               open_bytes(arguments.descriptor_path).and_then([](auto bytes) {
                                 return read_descriptors(std::move(bytes));
                               }));
    if (!descriptors) return tl::unexpected(std::move(descriptors.error()));
    if (descriptors->size() > 1) {
      return in_file<std::unique_ptr<TraceReader>>(
          arguments.descriptor_path,
          fail(ErrorCode::kUnknown, "",
               "holds " + std::to_string(descriptors->size()) + " different descriptors",
               "give a file with the one of the recorded interface"));
    }
    options.supplied.report_descriptor = std::move(descriptors->front().report_descriptor);
  }
  return in_file(arguments.path, open_bytes(arguments.path).and_then([&](auto bytes) {
    if (shows_progress) bytes = with_progress(arguments.path, std::move(bytes));
    return open(std::move(bytes), std::move(options));
  }));
}

}  // namespace

tl::expected<std::unique_ptr<TraceReader>, Failure> open_trace_input(
    const TraceArguments& arguments) {
  const bool prints_beside = ::isatty(STDOUT_FILENO) != 0;
  return open_input(arguments, open_trace, !prints_beside);
}

tl::expected<std::unique_ptr<TraceReader>, Failure> open_import_input(
    const TraceArguments& arguments) {
  return open_input(
      arguments,
      [](std::unique_ptr<ByteSource> bytes, TraceOptions options) {
        return open_import(std::move(bytes), std::move(options));
      },
      true);
}

std::string summarise(const TraceSummary& summary) {
  std::string text = count_of(summary.samples, "sample");
  const auto add = [&text](std::uint64_t count, std::string_view what) {
    if (count > 0) text += ", " + count_of(count, what);
  };
  text += losses_text(summary.losses());
  add(summary.repaired_transitions(), "repaired state transition");
  add(summary.damaged_parts, "damaged part");
  std::uint64_t undecodable = 0;
  for (const TraceDeviceSummary& device : summary.devices)
    undecodable += device.undecodable_reports;
  add(undecodable, "undecodable report");
  return text;
}

std::string losses_text(const StreamLosses& losses) {
  std::string text;
  if (losses.lost > 0) {
    text += losses.lost_estimated ? ", at least " : ", ";
    text += std::to_string(losses.lost) + " lost";
  }
  const auto add = [&text](std::uint64_t count, std::string_view what) {
    if (count > 0) text += ", " + count_of(count, what);
  };
  add(losses.overruns, "queue overrun");
  add(losses.gaps, "gap");
  add(losses.resets, "reset");
  add(losses.clock_jumps, "clock jump");
  return text;
}

std::string count_of(std::uint64_t count, std::string_view what) {
  return std::to_string(count) + ' ' + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace limn::app
