#pragma once

namespace limn::app {

/// Lets SIGINT and SIGTERM stop something while this lives; a second one ends the program. One at a
/// time. What is stopped has a stop() that signal handlers may call, and outlives this.
class StopOnSignal {
 public:
  template <class Stopped>
  explicit StopOnSignal(Stopped& stopped)
      : StopOnSignal(&stopped, [](void* object) { static_cast<Stopped*>(object)->stop(); }) {}
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  StopOnSignal(void* object, void (*stop)(void*));
};

}  // namespace limn::app
