// spnav_reader BUTTONS: a program of libspnav's, which says "open" and prints what it is told, a
// line each ("motion" and six numbers, "press" and "release" with one), until that many buttons
// were pressed or released. SPNAV_SOCKET: the server. A program of its own, as libspnav has one
// connection a process.

#include <cstdio>
#include <cstdlib>

#define SPNAV_CONFIG_H_
#include <spnav.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  if (spnav_open() == -1) {
    std::fputs("spnav_reader: no server answers\n", stderr);
    return 1;
  }
  std::puts("open");
  std::fflush(stdout);
  spnav_event event{};
  for (long left = std::strtol(argv[1], nullptr, 10); left > 0 && spnav_wait_event(&event) != 0;) {
    if (event.type == SPNAV_EVENT_MOTION) {
      const spnav_event_motion& m = event.motion;
      std::printf("motion %d %d %d %d %d %d\n", m.x, m.y, m.z, m.rx, m.ry, m.rz);
    } else if (event.type == SPNAV_EVENT_BUTTON) {
      std::printf("%s %d\n", event.button.press != 0 ? "press" : "release", event.button.bnum);
      --left;
    }
  }
  return spnav_close();
}
