#include "modeler/surface/box_tree.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "modeler/bspline/lanes.hpp"

namespace limn {
namespace {

using bspline_detail::Lanes;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kWidth = BoxNode::kWidth;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float round_down(double x) noexcept {
  constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
  if (!(x >= -kMost)) return -kInfinity;
  const auto rounded = static_cast<float>(std::min(x, kMost));
  return static_cast<double>(rounded) > x ? std::nextafter(rounded, -kInfinity) : rounded;
}

float round_up(double x) noexcept { return -round_down(-x); }

using FloatLanes [[gnu::vector_size(16)]] = float;

LIMN_KERNEL void load(const float* from, Lanes& to) noexcept {
  FloatLanes x;
  std::memcpy(&x, from, sizeof x);
  to = __builtin_convertvector(x, Lanes);
}

LIMN_KERNEL void larger(const Lanes& a, const Lanes& b, Lanes& out) noexcept {
  out = a > b ? a : b;
}
LIMN_KERNEL void smaller(const Lanes& a, const Lanes& b, Lanes& out) noexcept {
  out = a < b ? a : b;
}

LIMN_KERNEL void turn(const BoxNode& node, double x, double y, double z, Lanes& out) noexcept {
  Lanes a;
  Lanes b;
  Lanes c;
  load(node.columns[0].data(), a);
  load(node.columns[1].data(), b);
  load(node.columns[2].data(), c);
  out = a * x + b * y + c * z;
}

LIMN_KERNEL void from_center(const BoxNode& node, const double* p, Lanes& out) noexcept {
  turn(node, p[0] - static_cast<double>(node.center[0]), p[1] - static_cast<double>(node.center[1]),
       p[2] - static_cast<double>(node.center[2]), out);
}

/// Squares of distances of children half to half + 3, and of those to the middles of their boxes.
LIMN_KERNEL void measure_half(const BoxNode& node, const Lanes& q, std::size_t half, Lanes& square,
                              Lanes& middles) noexcept {
  const Lanes zero = {0, 0, 0, 0};
  square = middles = zero;
  for (std::size_t d = 0; d < 3; ++d) {
    Lanes low;
    Lanes high;
    load(node.low[d].data() + half, low);
    load(node.high[d].data() + half, high);
    const Lanes before = low - q[d];
    const Lanes after = q[d] - high;
    Lanes beside;
    larger(before, after, beside);
    larger(beside, zero, beside);
    square += beside * beside;
    middles += (before - after) * (before - after);
  }
}

/// Adds bits half to half + 3 where a < b.
LIMN_KERNEL void mark_less(const Lanes& a, const Lanes& b, std::size_t half,
                           unsigned& bits) noexcept {
  using Masks [[gnu::vector_size(32)]] = long long;
  const Masks marks = (a < b) & Masks{1, 2, 4, 8};
  bits |= static_cast<unsigned>((marks[0] | marks[1]) | (marks[2] | marks[3])) << half;
}

LIMN_KERNEL void measure_distances(const BoxNode& node, const double* p, double most, double* out,
                                   unsigned& bits) noexcept {
  Lanes q;
  from_center(node, p, q);
  const Lanes least = Lanes{0, 0, 0, 0} + most;
  for (std::size_t half = 0; half < kWidth; half += 4) {
    Lanes square;
    Lanes middles;
    measure_half(node, q, half, square, middles);
    mark_less(square, least, half, bits);
    std::memcpy(out + half, &square, sizeof square);
  }
}

LIMN_KERNEL void choose_nearest(const BoxNode& node, const double* p, double* out,
                                std::size_t& nearest) noexcept {
  Lanes q;
  from_center(node, p, q);
  std::array<std::uint64_t, kWidth> remoteness;
  for (std::size_t half = 0; half < kWidth; half += 4) {
    Lanes square;
    Lanes middles;
    measure_half(node, q, half, square, middles);
    std::memcpy(out + half, &square, sizeof square);
    constexpr double kPart = 1e-3;
    const Lanes sum = square + kPart * middles;
    std::memcpy(remoteness.data() + half, &sum, sizeof sum);
  }
  // As numbers without sign their bits are in the order of their values, those of no number (where
  // there is no child) last; the lowest bits may hold which child it is.
  constexpr std::uint64_t kChild = kWidth - 1;
  std::uint64_t least = remoteness[0] & ~kChild;
  for (std::size_t i = 1; i < kWidth; ++i) least = std::min(least, (remoteness[i] & ~kChild) | i);
  nearest = least & kChild;
}

LIMN_KERNEL void clip_ray(const BoxNode& node, const double* origin, const double* direction,
                          double most, double* first, unsigned& bits) noexcept {
  constexpr double kLeast = 1e-300;  // what divides without overflow
  Lanes q;
  Lanes along;
  from_center(node, origin, q);
  turn(node, direction[0], direction[1], direction[2], along);
  const Lanes zero = {0, 0, 0, 0};
  const Lanes least = zero + kLeast;
  along = along < least ? (along > -least ? least : along) : along;
  const Lanes inverse = 1 / along;
  // What turning rounds, relative to the longest coordinate it adds.
  const Lanes size = q < zero ? -q : q;
  const Lanes beside = zero + 1e-15 * (size[0] + size[1] + size[2]);
  const Lanes q_near = along > zero ? q + beside : q - beside;
  const Lanes q_far = along > zero ? q - beside : q + beside;
  for (std::size_t half = 0; half < kWidth; half += 4) {
    Lanes enter = zero;
    Lanes leave = zero + most;
    for (std::size_t d = 0; d < 3; ++d) {
      const bool up = along[d] > 0;
      Lanes plane;
      load((up ? node.low : node.high)[d].data() + half, plane);
      larger((plane - q_near[d]) * inverse[d], enter, enter);
      load((up ? node.high : node.low)[d].data() + half, plane);
      smaller((plane - q_far[d]) * inverse[d], leave, leave);
    }
    constexpr double kRounding = 1e-14;
    const Lanes rounding = zero + kRounding * leave + std::numeric_limits<double>::min();
    enter -= rounding;
    leave += rounding;
    std::memcpy(first + half, &enter, sizeof enter);
    mark_less(enter, leave, half, bits);
  }
}

LIMN_ON_EACH_PROCESSOR(distances_of,
                       (const BoxNode& node, const double* p, double most, double* out,
                        unsigned& bits),
                       (node, p, most, out, bits), measure_distances(node, p, most, out, bits))
LIMN_ON_EACH_PROCESSOR(nearest_of,
                       (const BoxNode& node, const double* p, double* out, std::size_t& nearest),
                       (node, p, out, nearest), choose_nearest(node, p, out, nearest))
LIMN_ON_EACH_PROCESSOR(passages_of,
                       (const BoxNode& node, const double* origin, const double* direction,
                        double most, double* first, unsigned& bits),
                       (node, origin, direction, most, first, bits),
                       clip_ray(node, origin, direction, most, first, bits))

/// A box that grows: in coordinates A (x - c), c being (0, 0, 0) for a node's own.
struct Extent {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;

  void add(const Vector3d& x) noexcept {
    for (Eigen::Index d = 0; d < 3; ++d) {
      // Written so that what overflowed to no number is in no way bounded.
      if (!(x[d] >= low[d]))
        low[d] = std::isnan(x[d]) ? -std::numeric_limits<double>::infinity() : x[d];
      if (!(x[d] <= high[d]))
        high[d] = std::isnan(x[d]) ? std::numeric_limits<double>::infinity() : x[d];
    }
  }
};

class TreeMaker {
 public:
  TreeMaker(std::span<const OrientedBox> leaves, std::vector<std::int32_t>& order)
      : leaves_(leaves), order_(order) {
    middles_.reserve(leaves.size());
    for (const OrientedBox& leaf : leaves) {
      const Vector3d middle =
          leaf.middle + leaf.axes.transpose() * (0.5 * leaf.low + 0.5 * leaf.high);
      middles_.push_back(middle.allFinite() ? middle : Vector3d(Vector3d::Zero()));
    }
  }

  std::vector<BoxNode> run() {
    nodes_.reserve(leaves_.size() / (kWidth - 1) + 8);
    std::size_t most = kWidth;
    while (most < leaves_.size()) most *= kWidth;
    add_node(0, leaves_.size(), most / kWidth);
    return std::move(nodes_);
  }

 private:
  /// A node of the leaves at [begin, end), of which a child has at most `below`: all nodes but the
  /// last ones of a level are full. Returns its box along its own axes.
  OrientedBox add_node(std::size_t begin, std::size_t end, std::size_t below) {
    const std::size_t number = nodes_.size();
    nodes_.emplace_back();
    const std::size_t count = (end - begin + below - 1) / below;
    part(begin, end, below, count);

    OrientedBox own;
    own.axes = axes_of(begin, end);
    const Vector3d center = middle_of(begin, end);
    std::array<float, 3> rounded_center{};
    for (Eigen::Index d = 0; d < 3; ++d) {
      // Any place will do, but one near keeps digits.
      rounded_center[static_cast<std::size_t>(d)] =
          std::abs(center[d]) < kFarthest ? static_cast<float>(center[d]) : 0.0F;
      own.middle[d] = static_cast<double>(rounded_center[static_cast<std::size_t>(d)]);
    }
    // Shrunk by more than rounding to floats may stretch.
    constexpr double kShrunk = 1 - 2e-7;
    const Eigen::Matrix3f axes = (kShrunk * own.axes).cast<float>();
    own.axes = axes.cast<double>();

    Extent whole;
    for (std::size_t i = 0; i < kWidth; ++i) {
      Extent extent;
      std::int32_t child = 0;
      if (i < count) {
        const std::size_t from = begin + i * below;
        const std::size_t to = std::min(end, from + below);
        OrientedBox box;
        if (to - from == 1) {
          child = ~static_cast<std::int32_t>(from);
          box = leaves_[static_cast<std::size_t>(order_[from])];
        } else {
          child = static_cast<std::int32_t>(nodes_.size());
          box = add_node(from, to, shrink(below, to - from));
        }
        extent = extent_of(box, own);
        whole.add(extent.low);
        whole.add(extent.high);
      }
      BoxNode& node = nodes_[number];
      node.child[i] = child;
      for (std::size_t d = 0; d < 3; ++d) {
        node.low[d][i] = round_down(extent.low[static_cast<Eigen::Index>(d)]);
        node.high[d][i] = round_up(extent.high[static_cast<Eigen::Index>(d)]);
        if (i >= count) {
          node.low[d][i] = kInfinity;
          node.high[d][i] = -kInfinity;
        }
      }
    }
    BoxNode& node = nodes_[number];
    for (std::size_t d = 0; d < 3; ++d) {
      node.center[d] = rounded_center[d];
      for (std::size_t c = 0; c < 3; ++c) {
        node.columns[c][d] = axes(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(c));
      }
    }
    own.low = whole.low;
    own.high = whole.high;
    return own;
  }

  /// What a child's children have at most.
  static std::size_t shrink(std::size_t below, std::size_t count) noexcept {
    do below /= kWidth;
    while (below >= count);
    return below;
  }

  /// Sorts the leaves at [begin, end) so that each of `parts` groups of `below` of them lies
  /// together: by halves, across the axis along which they reach farther.
  void part(std::size_t begin, std::size_t end, std::size_t below, std::size_t parts) {
    if (parts < 2) return;
    Extent extent;
    for (std::size_t i = begin; i < end; ++i) extent.add(middle(i));
    Eigen::Index axis = 0;
    (extent.high - extent.low).maxCoeff(&axis);
    const std::size_t cut = begin + parts / 2 * below;
    const auto at = [this](std::size_t i) {
      return order_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(cut), at(end), [&](std::int32_t a, std::int32_t b) {
      const double x = middles_[static_cast<std::size_t>(a)][axis];
      const double y = middles_[static_cast<std::size_t>(b)][axis];
      return x < y || (x == y && a < b);  // a total order, so that every run gives the same tree
    });
    part(begin, cut, below, parts / 2);
    part(cut, end, below, parts - parts / 2);
  }

  const Vector3d& middle(std::size_t i) const {
    return middles_[static_cast<std::size_t>(order_[i])];
  }
  Vector3d middle_of(std::size_t begin, std::size_t end) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = begin; i < end; ++i) sum += middle(i);
    return sum / static_cast<double>(end - begin);
  }

  /// Along the normals and first tangents of the leaves where those agree, else along x, y, z.
  Matrix3d axes_of(std::size_t begin, std::size_t end) const {
    Vector3d along = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const Matrix3d& axes = leaves_[static_cast<std::size_t>(order_[i])].axes;
      along += axes.row(0).transpose();
      normal += axes.row(2).transpose();
    }
    const auto count = static_cast<double>(end - begin);
    constexpr double kAgree = 0.5;
    if (!(normal.norm() > kAgree * count)) return Matrix3d::Identity();
    normal.normalize();
    along -= along.dot(normal) * normal;
    along = along.norm() > kAgree * count ? Vector3d(along.normalized()) : normal.unitOrthogonal();
    Matrix3d axes;
    axes << along.transpose(), normal.cross(along).transpose(), normal.transpose();
    return axes;
  }

  /// A box in the coordinates of another, from its corners, widened by what rounding may cost.
  static Extent extent_of(const OrientedBox& box, const OrientedBox& in) {
    const Matrix3d back = box.axes.inverse();
    Extent extent;
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
      Vector3d local;
      for (int d = 0; d < 3; ++d) local[d] = (corner >> d & 1) != 0 ? box.high[d] : box.low[d];
      const Vector3d x = box.middle + back * local;
      most = std::max(most, x.cwiseAbs().maxCoeff());
      extent.add(in.axes * (x - in.middle));
    }
    constexpr double kRounding = 1e-14;
    extent.low.array() -= kRounding * most;
    extent.high.array() += kRounding * most;
    return extent;
  }

  static constexpr double kFarthest = 1e30;

  std::span<const OrientedBox> leaves_;
  std::vector<std::int32_t>& order_;
  std::vector<Vector3d> middles_;
  std::vector<BoxNode> nodes_;
};

}  // namespace

unsigned BoxNode::square_distances(const Vector3d& p, double most, double* out) const noexcept {
  unsigned bits = 0;
  distances_of(*this, p.data(), most, out, bits);
  return bits;
}

std::size_t BoxNode::nearest_child(const Vector3d& p, double* out) const noexcept {
  std::size_t nearest = 0;
  nearest_of(*this, p.data(), out, nearest);
  return nearest;
}

unsigned BoxNode::passages(const Vector3d& origin, const Vector3d& direction, double most,
                           double* first) const noexcept {
  unsigned bits = 0;
  passages_of(*this, origin.data(), direction.data(), most, first, bits);
  return bits;
}

Eigen::AlignedBox<double, 3> BoxNode::child_box(std::size_t i) const {
  Matrix3d axes;
  Vector3d middle;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    middle[at] = static_cast<double>(center[c]);
    for (std::size_t d = 0; d < 3; ++d) {
      axes(static_cast<Eigen::Index>(d), at) = static_cast<double>(columns[c][d]);
    }
  }
  const Matrix3d back = axes.inverse();
  Eigen::AlignedBox<double, 3> box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vector3d local;
    for (std::size_t d = 0; d < 3; ++d) {
      local[static_cast<Eigen::Index>(d)] =
          static_cast<double>((corner >> d & 1U) != 0 ? high[d][i] : low[d][i]);
    }
    box.extend(middle + back * local);
  }
  return box;
}

std::vector<BoxNode> make_box_tree(std::span<const OrientedBox> leaves,
                                   std::vector<std::int32_t>& order) {
  order.resize(leaves.size());
  std::iota(order.begin(), order.end(), 0);
  if (leaves.size() < 2) return {};
  return TreeMaker(leaves, order).run();
}

}  // namespace limn
