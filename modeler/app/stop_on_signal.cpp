#include "modeler/app/stop_on_signal.hpp"

#include <signal.h>  // sigaction is POSIX

#include <atomic>

namespace limn::app {
namespace {

std::atomic<void*> stopped_by_signal = nullptr;
std::atomic<void (*)(void*)> stop_function = nullptr;  // set before the object

extern "C" void stop_it(int) {
  if (void* object = stopped_by_signal.load()) stop_function.load()(object);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;  // as the caller wants it
  action.sa_handler = handler;
  ::sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program at once
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopOnSignal::StopOnSignal(void* object, void (*stop)(void*)) {
  stop_function.store(stop);
  stopped_by_signal.store(object);
  handle(SIGINT, stop_it);
  handle(SIGTERM, stop_it);
}

StopOnSignal::~StopOnSignal() {
  handle(SIGINT, SIG_DFL);
  handle(SIGTERM, SIG_DFL);
  stopped_by_signal.store(nullptr);
}

}  // namespace limn::app
