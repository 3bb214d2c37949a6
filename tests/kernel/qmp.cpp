#include "tests/kernel/qmp.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>

namespace limn::test {

Qmp::Qmp() : serial_(::open("/dev/ttyS1", O_RDWR | O_NOCTTY | O_CLOEXEC)) {
  termios settings{};
  EXPECT_EQ(::tcgetattr(serial_, &settings), 0);
  ::cfmakeraw(&settings);
  EXPECT_EQ(::tcsetattr(serial_, TCSANOW, &settings), 0);
  // The greeting came before the line was raw, and Linux sent its echo back: QEMU complains of that
  // first, at any time.
  const std::string negotiate = "\n{\"execute\": \"qmp_capabilities\"}\n";
  for (int tries = 0; tries < 5; ++tries) {
    EXPECT_EQ(::write(serial_, negotiate.data(), negotiate.size()),
              static_cast<ssize_t>(negotiate.size()));
    for (std::string answer = line(); !answer.empty(); answer = line()) {
      if (answer.find("\"return\"") != std::string::npos) return;
    }
  }
  ADD_FAILURE() << "QEMU does not answer at /dev/ttyS1";
}

Qmp::~Qmp() { ::close(serial_); }

std::string Qmp::line() {
  // QEMU answers in its host's time, and the guest's clock would jump over it while it sleeps.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::string text;
  for (char c = 0; c != '\n';) {
    pollfd ready{serial_, POLLIN, 0};
    if (::poll(&ready, 1, 0) != 1) {
      if (std::chrono::steady_clock::now() > end) return "";
    } else if (::read(serial_, &c, 1) == 1) {
      text += c;
    }
  }
  return text;
}

std::string Qmp::ask(const std::string& command, const std::string& arguments) {
  const std::string text = R"({"execute": ")" + command + R"(", "arguments": )" + arguments + "}\n";
  EXPECT_EQ(::write(serial_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  for (;;) {  // greetings and news may come before it
    std::string answer = line();
    if (answer.empty() || answer.find("\"error\"") != std::string::npos) {
      ADD_FAILURE() << command << ": " << (answer.empty() ? "no answer" : answer);
      return answer;
    }
    if (answer.find("\"return\"") != std::string::npos) return answer;
  }
}

void Qmp::choose_pointer(const std::string& name) {
  const std::string mice = ask("query-mice");
  const std::size_t at = mice.find("\"" + name + "\"");
  const std::string key = "\"index\": ";
  const std::size_t index = at == std::string::npos ? at : mice.rfind(key, at);
  ASSERT_NE(index, std::string::npos) << name << " is not in " << mice;
  const int number = std::stoi(mice.substr(index + key.size()));
  ask("human-monitor-command", R"({"command-line": "mouse_set )" + std::to_string(number) + "\"}");
}

void Qmp::point(int x, int y, bool down) {
  const auto axis = [](const char* name, int value) {
    return std::string(R"({"type": "abs", "data": {"axis": ")") + name + R"(", "value": )" +
           std::to_string(value) + "}}, ";
  };
  ask("input-send-event", R"({"events": [)" + axis("x", x) + axis("y", y) +
                              R"({"type": "btn", "data": {"button": "left", "down": )" +
                              (down ? "true" : "false") + "}}]}");
}

}  // namespace limn::test
