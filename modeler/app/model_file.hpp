#pragma once

#include <string>
#include <vector>

#include "modeler/app/command.hpp"
#include "modeler/model/model.hpp"

namespace limn::app {

/// Formats of models, told apart by extension.
enum class ModelFormat { kJson, kStep, kIges };

/// .limn.json or .json, .step or .stp, .iges or .igs. A usage error for others.
tl::expected<ModelFormat, Failure> model_format_of(const std::string& path);

struct ModelFile {
  Model model;
  std::vector<std::string> skipped;  ///< what was not read, an entity a line
};

tl::expected<ModelFile, Failure> read_model(const std::string& path);

/// How far what a file gives back is from what was written.
struct ReadBack {
  std::size_t faces = 0;
  std::size_t curves = 0;
  double deviation_mm = 0;  ///< of surfaces and free curves, at equal parameters
};

/// Writes the model, reads the file back before it gets its name, and compares. Error: kNumeric
/// where the file does not give back as many faces as went in; then it is not left behind.
tl::expected<ReadBack, Failure> write_model(const Model& model, const std::string& path,
                                            bool ap242);

}  // namespace limn::app
