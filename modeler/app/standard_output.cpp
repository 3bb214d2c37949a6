#include "modeler/app/standard_output.hpp"

namespace limn::app {

Outcome StandardOutput::flush() {
  Outcome written = print(text_);
  text_.clear();
  return written;
}

Outcome print(std::string_view text) {
  return in_file("standard output", OutputFile::open("-").and_then(
                                        [text](OutputFile file) { return file.write(text); }));
}

}  // namespace limn::app
