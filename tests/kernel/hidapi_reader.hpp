#pragma once

/// Opens a device by hidapi's libusb backend, as other programs do, at a path of it as hidapi has
/// them, and gives its next `count` reports. False: it cannot be opened, or nothing came for 20 s.
///
/// A library of its own, loaded apart (RTLD_DEEPBIND): hidapi's backends have the same symbols, and
/// limn has the other one. Not two at a time may be opened.
extern "C" bool read_by_hidapi(const char* path, long count, void (*opened)(void* reader),
                               void (*report)(void* reader, const unsigned char* bytes, int size),
                               void* reader);
