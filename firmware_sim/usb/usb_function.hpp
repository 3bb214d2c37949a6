#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

/// What a device puts behind the USB device core (usb_device.hpp): what it says of itself, as
/// constants, and its own code. Memory: constants and the object's own members; no heap, exceptions
/// or RTTI. One thread at a time.
namespace limn::firmware {

/// The eight bytes that begin a control transfer [USB 2.0, 9.3].
struct SetupPacket {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

/// An interrupt endpoint of an interface.
struct EndpointSpec {
  std::uint8_t address = 0;      ///< number, bit 7 set for IN
  std::uint16_t most_bytes = 0;  ///< wMaxPacketSize
  std::uint8_t interval_ms = 1;  ///< bInterval of full speed
};

/// A HID interface.
struct InterfaceSpec {
  std::span<const std::uint8_t> report_descriptor;
  std::uint8_t subclass = 0;  ///< 1: boot
  std::uint8_t protocol = 0;  ///< 1 keyboard, 2 mouse; with subclass 1 only
  std::span<const EndpointSpec> endpoints;
};

/// Where a device hangs, as Linux numbers buses (linux/input.h, BUS_*). One that is paired over
/// Bluetooth answers as over USB: a link that can only do USB takes it for a USB device.
enum class Bus : std::uint16_t { kUsb = 0x03, kBluetooth = 0x05 };

/// Bits of bmAttributes [USB 2.0, 9.6.3]; bit 7 is always set.
inline constexpr std::uint8_t kBusPowered = 0x80;
inline constexpr std::uint8_t kSelfPowered = 0xC0;
inline constexpr std::uint8_t kRemoteWakeup = 0xA0;  ///< bus-powered, and may wake the host

/// A full-speed device with one configuration of HID interfaces, numbered from 0.
struct DeviceSpec {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;            ///< bcdDevice
  std::string_view manufacturer;        ///< ASCII; empty: no string
  std::string_view product_name;        ///< ASCII; empty: no string
  std::string_view serial_number = {};  ///< ASCII; empty: no string
  std::span<const InterfaceSpec> interfaces;

  // What most devices leave at that.
  Bus bus = Bus::kUsb;
  std::uint16_t usb_version = 0x0200;    ///< bcdUSB
  std::uint16_t hid_version = 0x0111;    ///< bcdHID
  std::uint8_t most_control_bytes = 64;  ///< bMaxPacketSize0
  std::uint8_t attributes = kBusPowered;
  std::uint16_t power_ma = 100;         ///< bMaxPower is in units of 2 mA
  std::uint8_t manufacturer_index = 1;  ///< of the string, where there is one; all must differ
  std::uint8_t product_index = 2;
  std::uint8_t serial_index = 3;
};

enum class ReportKind : std::uint8_t { kInput = 1, kOutput = 2, kFeature = 3 };

/// A device's own code. Every answer has its default: a device that can nothing but report.
class UsbFunction {
 public:
  virtual const DeviceSpec& spec() const noexcept = 0;

  /// The bus was reset, or the device was plugged in: as if it were switched on.
  virtual void reset() noexcept = 0;

  /// The next input report of an interface, due at or before `now` (since the simulation began),
  /// the report ID first where reports are numbered. Bytes written to `report`; 0: nothing to say,
  /// the host is told NAK. Reports wait for the host, as many as the device can hold.
  virtual std::size_t next_report(std::uint8_t interface, std::chrono::microseconds now,
                                  std::span<std::uint8_t> report) noexcept = 0;

  /// Where next_report() had nothing to say at `now`: until then it has not either, at any
  /// interface, unless the host asks or tells something. `now`: that is not known.
  virtual std::chrono::microseconds silent_until(std::chrono::microseconds now) const noexcept {
    return now;
  }

  static constexpr int kStall = -1;

  /// A string descriptor that the core does not make of the spec (vendors hide parameters there,
  /// and reading one may switch the device): its bytes with length and type, or kStall.
  virtual int string_descriptor(std::uint8_t /*index*/, std::uint16_t /*language*/,
                                std::span<std::uint8_t> /*out*/) noexcept {
    return kStall;
  }

  /// GET_REPORT: bytes of the report, its ID first where reports are numbered, or kStall.
  virtual int get_report(std::uint8_t /*interface*/, ReportKind, std::uint8_t /*id*/,
                         std::span<std::uint8_t> /*out*/) noexcept {
    return kStall;
  }

  /// SET_REPORT, or bytes to an interrupt-out endpoint (an output report): the ID first where
  /// reports are numbered, 0 where they are not. False: stall.
  virtual bool set_report(std::uint8_t /*interface*/, ReportKind, std::uint8_t /*id*/,
                          std::span<const std::uint8_t> /*bytes*/) noexcept {
    return false;
  }

  /// A vendor or other request that the core does not know; bytes answered, or kStall.
  virtual int vendor_request(const SetupPacket&, std::span<const std::uint8_t> /*out_data*/,
                             std::span<std::uint8_t> /*in_data*/) noexcept {
    return kStall;
  }

 protected:
  UsbFunction() = default;
  UsbFunction(const UsbFunction&) = default;
  UsbFunction& operator=(const UsbFunction&) = default;
  ~UsbFunction() = default;  // owned by its own type: no heap, so nothing is deleted through this
};

}  // namespace limn::firmware
