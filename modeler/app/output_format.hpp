#pragma once

namespace limn::app {

/// What goes to standard output (--format). Files are chosen by their extension, not by this.
enum class OutputFormat {
  kText,   ///< for people
  kJson,   ///< one document
  kJsonl,  ///< one JSON object a line
  kCsv,    ///< RFC 4180, with a header line
};

}  // namespace limn::app
