#include "modeler/bspline/refine.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Coordinates as `blocks` of `count` layers of `layer` doubles: one direction between those before
/// and those after it.
struct Layers {
  std::size_t layer;
  std::size_t count;
  std::size_t blocks;
};

/// Of so many coordinates, `width` a control point.
Layers layers_of(std::span<const KnotVector> knots, int direction, std::size_t width,
                 std::size_t size) {
  const auto count = [&](int d) {
    return static_cast<std::size_t>(knots[static_cast<std::size_t>(d)].basis_count());
  };
  Layers out{width, count(direction), 0};
  for (int d = 0; d < direction; ++d) out.layer *= count(d);
  out.blocks = size / (out.layer * out.count);
  return out;
}

Layers layers_of(const SplineData& spline, int direction) {
  return layers_of(spline.knots(), direction, static_cast<std::size_t>(spline.width()),
                   spline.coordinates().size());
}

Expected<SplineData> with_direction(const SplineData& spline, int direction, KnotVector knots,
                                    PagedArray coordinates) {
  std::vector<KnotVector> all(spline.knots().begin(), spline.knots().end());
  all[static_cast<std::size_t>(direction)] = std::move(knots);
  return SplineData::make(all, spline.dimension(), spline.form(), std::move(coordinates));
}

/// Which row of the map makes a layer: a periodic direction's last ones repeat its first, which the
/// map gives up to rounding only.
struct Rows {
  explicit Rows(const KnotRefinement& refinement)
      : count(static_cast<std::size_t>(refinement.map.rows())),
        round(count - static_cast<std::size_t>(
                          refinement.knots.is_periodic() ? refinement.knots.degree() : 0)) {}
  std::size_t of(std::size_t layer) const noexcept { return layer < round ? layer : layer % round; }

  std::size_t count;
  std::size_t round;
};

/// Coordinates to read: a spline's, or those between one direction and the next.
class Source {
 public:
  explicit Source(const PagedArray& pages) : pages_(&pages) {}
  explicit Source(const double* values) : values_(values) {}

  /// As PagedArray::run(), for any count.
  const double* run(std::size_t i, std::size_t count, double* scratch) const {
    if (values_ != nullptr) return values_ + i;
    if (count <= PagedArray::kPageSize) return pages_->run(i, count, scratch);
    pages_->read(i, {scratch, count});
    return scratch;
  }

 private:
  const PagedArray* pages_ = nullptr;
  const double* values_ = nullptr;
};

using Scratch = std::unique_ptr<double[]>;

Scratch make_scratch(std::size_t size) {
  return std::make_unique_for_overwrite<double[]>(size + PagedArray::kPadding);
}

/// Layers of few doubles: some blocks at a time. Coordinates are asked for in ascending order.
class BlockRefinement {
 public:
  BlockRefinement(Source from, const Layers& in, const KnotRefinement& refinement)
      : from_(from),
        in_(in),
        map_(refinement.map),
        rows_(refinement),
        old_size_(in.count * in.layer),
        size_(rows_.count * in.layer),
        most_(std::min(in.blocks, std::max(kDoubles / size_ / kBlocksTogether, std::size_t{1}) *
                                      kBlocksTogether)),
        scratch_(make_scratch(most_ * (old_size_ + PagedArray::kPadding))),
        blocks_(most_),
        made_(make_scratch(most_ * size_)) {}

  void operator()(std::size_t at, std::span<double> out) {
    while (!out.empty()) {
      std::size_t part = 0;
      if (at == (first_ + count_) * size_) {
        begin_next();
        if (out.size() >= count_ * size_) {
          make(out.data());
          part = count_ * size_;
        } else {
          make(made_.get());
        }
      }
      if (part == 0) {
        const std::size_t begin = at - first_ * size_;
        part = std::min(count_ * size_ - begin, out.size());
        std::copy_n(made_.get() + begin, part, out.data());
      }
      out = out.subspan(part);
      at += part;
    }
  }

 private:
  static constexpr std::size_t kDoubles = 4096;  ///< that the processor keeps near

  void begin_next() {
    first_ += count_;
    count_ = std::min(most_, in_.blocks - first_);
  }
  /// The blocks from first_ on.
  void make(double* out) {
    for (std::size_t b = 0; b < count_; ++b) {
      blocks_[b] = from_.run((first_ + b) * old_size_, old_size_,
                             scratch_.get() + b * (old_size_ + PagedArray::kPadding));
    }
    map_layers(map_, in_.layer, {blocks_.data(), count_}, out);
    const std::size_t round = rows_.round * in_.layer;
    for (std::size_t b = 0; b < count_; ++b, out += size_) {
      for (std::size_t i = round; i < size_; ++i) out[i] = out[i - round];
    }
  }

  Source from_;
  Layers in_;
  const ControlPointMap& map_;
  Rows rows_;
  std::size_t old_size_;
  std::size_t size_;
  std::size_t most_;
  Scratch scratch_;
  std::vector<const double*> blocks_;
  Scratch made_;
  std::size_t first_ = 0;  ///< block that made_ begins with
  std::size_t count_ = 0;  ///< blocks that it holds
};

/// Layers of many doubles: as much of one as a page has room for at a time.
class LayerRefinement {
 public:
  LayerRefinement(Source from, const Layers& in, const KnotRefinement& refinement)
      : from_(from),
        in_(in),
        map_(refinement.map),
        rows_(refinement),
        scratch_(make_scratch(static_cast<std::size_t>(map_.width()) * kRoom)),
        terms_(static_cast<std::size_t>(map_.width())) {}

  void operator()(std::size_t at, std::span<double> out) {
    while (!out.empty()) {
      const std::size_t layer = at / in_.layer;
      const std::size_t begin = at % in_.layer;
      const std::size_t count =
          std::min({in_.layer - begin, out.size(), std::size_t{PagedArray::kPageSize}});
      const auto sum = map_.sum(static_cast<int>(rows_.of(layer % rows_.count)));
      const auto size = static_cast<std::size_t>(sum.size);
      const std::size_t first =
          layer / rows_.count * in_.count + static_cast<std::size_t>(sum.first);
      for (std::size_t k = 0; k < size; ++k) {
        terms_[k] = from_.run((first + k) * in_.layer + begin, count, scratch_.get() + k * kRoom);
      }
      add_layers({sum.coefficients, size}, terms_.data(), count, out.data());
      out = out.subspan(count);
      at += count;
    }
  }

 private:
  static constexpr std::size_t kRoom = PagedArray::kPageSize + PagedArray::kPadding;

  Source from_;
  Layers in_;
  const ControlPointMap& map_;
  Rows rows_;
  Scratch scratch_;
  std::vector<const double*> terms_;
};

/// Calls `use` with what fills an array with the refined coordinates.
template <class Use>
void with_refinement(Source from, const Layers& in, const KnotRefinement& refinement, Use use) {
  constexpr std::size_t kFew = 16;
  if (in.layer < kFew) {
    use(BlockRefinement(from, in, refinement));
  } else {
    use(LayerRefinement(from, in, refinement));
  }
}

struct Step {
  int direction;
  const KnotRefinement* refinement;
};

/// One direction after another; only what comes out at the end is checked and put into pages.
Expected<SplineData> refine_along(const SplineData& spline, std::span<const Step> steps) {
  if (steps.empty()) return spline;
  std::vector<KnotVector> knots(spline.knots().begin(), spline.knots().end());
  Scratch between;
  Source from(spline.coordinates());
  std::size_t size = spline.coordinates().size();
  PagedArray made;
  for (const Step& step : steps) {
    const Layers in =
        layers_of(knots, step.direction, static_cast<std::size_t>(spline.width()), size);
    size = in.blocks * static_cast<std::size_t>(step.refinement->map.rows()) * in.layer;
    knots[static_cast<std::size_t>(step.direction)] = step.refinement->knots;
    const bool last = &step == &steps.back();
    with_refinement(from, in, *step.refinement, [&](auto fill) {
      if (last) {
        made = PagedArray::generate(size,
                                    [&](std::size_t at, std::span<double> out) { fill(at, out); });
      } else {
        Scratch next = make_scratch(size);
        fill(0, {next.get(), size});
        between = std::move(next);
        from = Source(between.get());
      }
    });
  }
  return SplineData::make(knots, spline.dimension(), spline.form(), std::move(made));
}

}  // namespace

Expected<SplineData> refine(const SplineData& spline, int direction,
                            const KnotRefinement& refinement) {
  LIMN_EXPECT(refinement.map.columns() == spline.knots(direction).basis_count());
  const Step step{direction, &refinement};
  return refine_along(spline, {&step, 1});
}

Expected<SplineData> insert_knots(const SplineData& spline, int direction,
                                  std::span<const double> added) {
  if (added.empty()) return spline;
  auto refinement = insert_knots(spline.knots(direction), added);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

Expected<SplineData> insert_knots(const SplineData& spline,
                                  std::span<const std::span<const double>> added) {
  LIMN_EXPECT(added.size() == spline.knots().size());
  std::vector<KnotRefinement> refinements;
  std::vector<Step> steps;
  refinements.reserve(added.size());  // steps point into it
  for (std::size_t d = 0; d < added.size(); ++d) {
    if (added[d].empty()) continue;
    auto refinement = insert_knots(spline.knots(static_cast<int>(d)), added[d]);
    if (!refinement) return tl::unexpected(std::move(refinement.error()));
    refinements.push_back(*std::move(refinement));
    steps.push_back({static_cast<int>(d), &refinements.back()});
  }
  return refine_along(spline, steps);
}

Expected<SplineData> elevate_degree(const SplineData& spline, int direction, int by) {
  auto refinement = elevate_degree(spline.knots(direction), by);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

Expected<SplineData> segment(const SplineData& spline, int direction, double low, double high) {
  auto part = segment_knots(spline.knots(direction), low, high);
  if (!part) return tl::unexpected(std::move(part.error()));
  return refine(spline, direction, *part);
}

Expected<SplineData> reverse(const SplineData& spline, int direction) {
  auto turned = reverse_knots(spline.knots(direction));
  if (!turned) return tl::unexpected(std::move(turned.error()));
  return refine(spline, direction, *turned);
}

Expected<SplineData> to_bezier(const SplineData& spline, int direction) {
  return refine(spline, direction, bezier_knots(spline.knots(direction)));
}

Expected<SplineData> move_seam(const SplineData& spline, int direction, double u) {
  const KnotVector& knots = spline.knots(direction);
  LIMN_EXPECT(knots.is_periodic() && u >= knots.domain_begin() && u < knots.domain_end());
  const double asked[] = {u};
  const bool is_knot = knots.multiplicity(u) > 0;
  auto with_knot =
      insert_knots(spline, direction, is_knot ? std::span<const double>() : std::span(asked));
  if (!with_knot) return with_knot;
  const KnotVector& old = with_knot->knots(direction);
  const int shift = old.find_span(u) - old.degree();
  auto rotated = old.rotated(shift);
  if (!rotated) return tl::unexpected(std::move(rotated.error()));

  const Layers in = layers_of(*with_knot, direction);
  const std::size_t round = in.count - static_cast<std::size_t>(old.degree());
  const std::vector<double> from = with_knot->coordinates().to_vector();
  std::vector<double> to(from.size());
  for (std::size_t b = 0; b < in.blocks; ++b) {
    for (std::size_t layer = 0; layer < in.count; ++layer) {
      const std::size_t source = (layer + static_cast<std::size_t>(shift)) % round;
      std::copy_n(from.data() + (b * in.count + source) * in.layer, in.layer,
                  to.data() + (b * in.count + layer) * in.layer);
    }
  }
  return with_direction(*with_knot, direction, *std::move(rotated), PagedArray(to));
}

}  // namespace limn
