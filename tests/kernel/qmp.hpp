#pragma once

#include <string>

namespace limn::test {

/// The control of the QEMU that runs this guest, at its second serial line: one JSON object a line.
class Qmp {
 public:
  /// Fails the test where nobody answers.
  Qmp();
  ~Qmp();
  Qmp(const Qmp&) = delete;

  /// The answer to `command`, which has no arguments, or these (an object).
  std::string ask(const std::string& command, const std::string& arguments = "{}");

  /// From now on QEMU's pointer events go to the device whose name in query-mice is `name`.
  void choose_pointer(const std::string& name);

  /// The pointer is at x, y (0 to 32767) with its left button down or up.
  void point(int x, int y, bool down);

 private:
  std::string line();

  int serial_;
};

}  // namespace limn::test
