#include "modeler/app/model_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <utility>

#include "input/base/byte_stream.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/exchange/cad_files.hpp"
#include "modeler/exchange/model_json.hpp"

namespace limn::app {
namespace {

struct Extension {
  std::string_view text;
  ModelFormat format;
};

constexpr std::array<Extension, 5> kExtensions = {{{".json", ModelFormat::kJson},
                                                   {".step", ModelFormat::kStep},
                                                   {".stp", ModelFormat::kStep},
                                                   {".iges", ModelFormat::kIges},
                                                   {".igs", ModelFormat::kIges}}};

/// Files beyond this are no models that fit in memory with what is made of them.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

Expected<std::string> all_of(ByteSource& source) {
  std::string bytes;
  std::vector<char> block(std::size_t{1} << 20);
  for (;;) {
    const auto count = source.read(block);
    if (!count) return tl::unexpected(count.error());
    if (*count == 0) return bytes;
    bytes.append(block.data(), *count);
    if (bytes.size() > kMostBytes) {
      return fail(ErrorCode::kLimit, "", "the file is larger than 1 GB", "split the model");
    }
  }
}

tl::expected<std::string, Failure> read_file(const std::string& path) {
  return in_file(path, open_bytes(path).and_then([](auto source) { return all_of(*source); }));
}

tl::expected<ModelFile, Failure> read_as(ModelFormat format, const std::string& path) {
  if (format == ModelFormat::kIges) {
    // Open CASCADE reads it by itself and does not say why it cannot.
    if (auto there = in_file(path, open_bytes(path)); !there) {
      return tl::unexpected(std::move(there.error()));
    }
    auto read = in_file(path, model_from_iges(path));
    if (!read) return tl::unexpected(std::move(read.error()));
    return ModelFile{std::move(read->model), std::move(read->skipped)};
  }
  auto bytes = read_file(path);
  if (!bytes) return tl::unexpected(std::move(bytes.error()));
  if (format == ModelFormat::kJson) {
    auto read = in_file(path, model_from_json(*bytes));
    if (!read) return tl::unexpected(std::move(read.error()));
    return ModelFile{*std::move(read), {}};
  }
  auto read = in_file(path, model_from_step(*bytes));
  if (!read) return tl::unexpected(std::move(read.error()));
  return ModelFile{std::move(read->model), std::move(read->skipped)};
}

constexpr int kPlaces = 32;  ///< a direction, at which what is read back is compared

/// Of two domains the parameter at part i of kPlaces.
double place(const KnotVector& knots, int i) {
  return knots.domain_begin() + (knots.domain_end() - knots.domain_begin()) * i / kPlaces;
}

double gap(const BsplineSurface& a, const BsplineSurface& b) {
  double out = 0;
  for (int j = 0; j <= kPlaces; ++j) {
    for (int i = 0; i <= kPlaces; ++i) {
      out = std::max(out, (a.point({place(a.knots(0), i), place(a.knots(1), j)}) -
                           b.point({place(b.knots(0), i), place(b.knots(1), j)}))
                              .norm());
    }
  }
  return out;
}

std::vector<const BsplineSurface*> surfaces_of(const Model& model) {
  std::vector<const BsplineSurface*> out;
  for (const Body& body : model.bodies) {
    for (const Face& face : body.faces) out.push_back(&face.surface);
  }
  return out;
}

Expected<ReadBack> compare(const Model& written, const Model& read) {
  const auto before = surfaces_of(written);
  const auto after = surfaces_of(read);
  if (before.size() != after.size()) {
    return fail(ErrorCode::kNumeric, "",
                "of " + std::to_string(before.size()) + " faces the file gives back " +
                    std::to_string(after.size()),
                "write another format, and report this model");
  }
  ReadBack out{before.size(), read.curves.size(), 0};
  for (std::size_t i = 0; i < before.size(); ++i) {
    out.deviation_mm = std::max(out.deviation_mm, gap(*before[i], *after[i]));
  }
  if (written.curves.size() != read.curves.size()) return out;  // cut at kinks
  for (std::size_t i = 0; i < read.curves.size(); ++i) {
    const BsplineCurve<3>& a = written.curves[i].curve;
    const BsplineCurve<3>& b = read.curves[i].curve;
    for (int k = 0; k <= kPlaces; ++k) {
      out.deviation_mm = std::max(
          out.deviation_mm, (a.point(place(a.knots(), k)) - b.point(place(b.knots(), k))).norm());
    }
  }
  return out;
}

}  // namespace

tl::expected<ModelFormat, Failure> model_format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto found = std::find_if(kExtensions.begin(), kExtensions.end(),
                                  [&](const Extension& e) { return e.text == extension; });
  if (found == kExtensions.end()) {
    return usage_error("'" + path + "' has no extension of a model that limn knows",
                       "choose .limn.json, .step or .iges");
  }
  return found->format;
}

tl::expected<ModelFile, Failure> read_model(const std::string& path) {
  const auto format = model_format_of(path);
  if (!format) return tl::unexpected(format.error());
  return read_as(*format, path);
}

tl::expected<ReadBack, Failure> write_model(const Model& model, const std::string& path,
                                            bool ap242) {
  const auto format = model_format_of(path);
  if (!format) return tl::unexpected(format.error());
  auto file = in_file(path, OutputFile::open(path));
  if (!file) return tl::unexpected(std::move(file.error()));
  Expected<std::string> bytes;
  switch (*format) {
    case ModelFormat::kJson:
      bytes = model_to_json(model);
      break;
    case ModelFormat::kStep:
      bytes = model_to_step(model, ap242 ? StepSchema::kAp242 : StepSchema::kAp214);
      break;
    case ModelFormat::kIges:
      bytes = model_to_iges(model);
      break;
  }
  const Expected<void> written =
      bytes.and_then([&](const std::string& b) { return file->write(b); }).and_then([&] {
        return file->finish();
      });
  if (!written) return in_file(path, Expected<ReadBack>(tl::unexpected(written.error())));
  auto read = read_as(*format, file->written_path());
  if (!read) {
    read.error().file = path;
    return tl::unexpected(std::move(read.error()));
  }
  auto report = in_file(path, compare(model, read->model));
  if (!report) return report;
  if (auto named = in_file(path, file->commit()); !named) {
    return tl::unexpected(std::move(named.error()));
  }
  return report;
}

}  // namespace limn::app
