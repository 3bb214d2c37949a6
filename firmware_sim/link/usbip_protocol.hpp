#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_sim/usb/bus_device.hpp"

/// The packets of USB/IP, version 1.1.1: numbers big-endian, but the setup packet as USB has it,
/// low byte first. Source: linux/Documentation/usb/usbip_protocol.rst.
namespace limn::firmware::usbip {

inline constexpr std::uint16_t kVersion = 0x0111;
inline constexpr std::uint16_t kDefaultPort = 3240;

/// The one device that limn exports: bus 1, device 2.
inline constexpr std::string_view kBusId = "1-1";
inline constexpr std::uint32_t kBusNumber = 1;
inline constexpr std::uint32_t kDeviceNumber = 2;
inline constexpr std::uint32_t kDeviceId = kBusNumber << 16 | kDeviceNumber;
inline constexpr std::uint32_t kFullSpeed = 2;

inline constexpr std::size_t kOperationBytes = 8;
inline constexpr std::size_t kBusIdBytes = 32;
inline constexpr std::size_t kDeviceBytes = 312;
inline constexpr std::size_t kUrbBytes = 48;

enum class Operation : std::uint16_t {
  kRequestImport = 0x8003,
  kReplyImport = 0x0003,
  kRequestList = 0x8005,
  kReplyList = 0x0005
};

/// What an operation came to.
enum class OperationStatus : std::uint32_t { kDone = 0, kRefused = 1, kBusy = 2, kNoDevice = 4 };

enum class Command : std::uint32_t {
  kSubmit = 1,
  kUnlink = 2,
  kReturnSubmit = 3,
  kReturnUnlink = 4
};

/// Linux's error numbers, as they travel (on every machine those of x86).
inline constexpr std::int32_t kStallStatus = -32;      ///< EPIPE
inline constexpr std::int32_t kNoDeviceStatus = -19;   ///< ENODEV
inline constexpr std::int32_t kUnlinkedStatus = -104;  ///< ECONNRESET

/// The first eight bytes of an operation.
struct OperationHeader {
  std::uint16_t version = kVersion;
  std::uint16_t code = 0;
  std::uint32_t status = 0;
};

/// CMD_SUBMIT, or CMD_UNLINK, from a client; as sent, nothing checked.
struct UrbHeader {
  std::uint32_t command = 0;
  std::uint32_t sequence = 0;
  std::uint32_t direction = 0;  ///< 0: to the device, and its data follow; 1: to the host
  std::uint32_t endpoint = 0;   ///< 0 to 15
  std::uint32_t length = 0;     ///< of a submit: bytes of data, or room for them
  std::uint32_t packets = 0;    ///< of a submit: of an isochronous transfer; else 0 or 2^32 - 1
  SetupPacket setup;            ///< of a submit to endpoint 0
  std::uint32_t unlinked = 0;   ///< of an unlink: the sequence number of what is to be unlinked
};

OperationHeader read_operation(std::span<const std::uint8_t, kOperationBytes> bytes) noexcept;
UrbHeader read_urb(std::span<const std::uint8_t, kUrbBytes> bytes) noexcept;

void append_operation(std::vector<std::uint8_t>& out, Operation code, OperationStatus status);

/// The 312 bytes that describe the device.
void append_device(std::vector<std::uint8_t>& out, const DeviceSpec& spec);

/// Four bytes for each interface, as a list has them behind the device.
void append_interfaces(std::vector<std::uint8_t>& out, const DeviceSpec& spec);

/// RET_SUBMIT: `data` follows it where the transfer was to the host; `actual` is its length, or how
/// many bytes the device took.
void append_returned_submit(std::vector<std::uint8_t>& out, std::uint32_t sequence,
                            std::int32_t status, std::uint32_t actual,
                            std::span<const std::uint8_t> data);

void append_returned_unlink(std::vector<std::uint8_t>& out, std::uint32_t sequence,
                            std::int32_t status);

void append_number(std::vector<std::uint8_t>& out, std::uint32_t value);
void append_number(std::vector<std::uint8_t>& out, std::uint16_t value);

}  // namespace limn::firmware::usbip
