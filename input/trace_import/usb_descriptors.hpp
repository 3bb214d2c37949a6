#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "input/trace/noted_string.hpp"
#include "input/trace/trace.hpp"
#include "input/trace_import/usb_packet.hpp"

namespace limn {

/// What a capture has told of one device, by the descriptors that its host asked for. [USB 2.0 ch.
/// 9]
///
/// A host asks for the same thing several times, first for its beginning only: the longest answer
/// counts, until the device descriptor shows that another device has the address.
class UsbDescriptors {
 public:
  /// An answer to GET_DESCRIPTOR, empty where the device stalled. `index` is that of the string,
  /// or of the interface whose report descriptor it is. True if it says something new of how
  /// reports are laid out: ids, a report descriptor, a noted string.
  bool answered(std::uint8_t type, std::uint8_t index, std::span<const std::uint8_t> answer);

  std::uint16_t vendor() const noexcept { return vendor_; }
  std::uint16_t product() const noexcept { return product_; }
  std::uint16_t version() const noexcept { return version_; }

  /// "Manufacturer Product", as far as known; UTF-8.
  std::string name() const;

  /// The interface that an endpoint (its number, without direction) towards the host belongs to.
  std::optional<std::uint8_t> interface_of(std::uint8_t endpoint) const noexcept;

  /// Whether that interface may send HID reports: it says so, or nothing is known of it.
  bool may_be_hid(std::uint8_t interface) const noexcept;

  /// By interface number; none of an interface whose report descriptor is not in the capture.
  const std::map<std::uint8_t, std::vector<std::uint8_t>>& report_descriptors() const noexcept {
    return report_descriptors_;
  }

  /// The vendor's strings (index 100 and up), in which tablets keep their parameters.
  const std::vector<NotedString>& strings() const noexcept { return strings_; }

  static constexpr std::size_t kMostStrings = 16;

 private:
  struct Interface {
    std::uint8_t interface_class = 0;
    std::size_t descriptor_bytes = 0;  // wDescriptorLength of its HID descriptor; 0: not known
  };

  bool take_device(std::span<const std::uint8_t> answer);
  bool take_string(std::uint8_t index, std::span<const std::uint8_t> answer);
  void take_configuration(std::span<const std::uint8_t> answer);
  bool take_report_descriptor(std::uint8_t interface, std::span<const std::uint8_t> answer);

  std::vector<std::uint8_t> device_;  // its descriptor
  std::uint16_t vendor_ = 0;
  std::uint16_t product_ = 0;
  std::uint16_t version_ = 0;
  std::map<std::uint8_t, std::string> texts_;  // manufacturer and product, by index
  std::vector<NotedString> strings_;
  std::size_t configuration_bytes_ = 0;
  std::map<std::uint8_t, Interface> interfaces_;
  std::array<std::optional<std::uint8_t>, 16> interface_of_endpoint_{};
  std::map<std::uint8_t, std::vector<std::uint8_t>> report_descriptors_;
};

/// Ties the answers of GET_DESCRIPTOR to the requests. Holds at most kMostOpen of them.
class UsbDescriptorRequests {
 public:
  struct Answer {
    std::uint16_t bus = 0;
    std::uint16_t device = 0;
    std::uint8_t type = 0;
    std::uint8_t index = 0;  ///< of the string, or the interface of a report descriptor
    std::span<const std::uint8_t> bytes;
  };

  /// Takes in a control packet; gives an answer where it completes one.
  std::optional<Answer> take(const UsbPacket& packet);

  static constexpr std::size_t kMostOpen = 1024;

 private:
  struct Key {
    std::uint16_t bus;
    std::uint16_t device;
    std::uint64_t request;
    auto operator<=>(const Key&) const = default;
  };
  struct Request {
    std::uint8_t type;
    std::uint8_t index;
  };
  std::map<Key, Request> open_;
};

}  // namespace limn
