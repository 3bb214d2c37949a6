#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace limn {

/// A plane path of straight and cubic Bezier segments, in mm, y down the page.
class Path {
 public:
  enum class Verb : std::uint8_t { kMove, kLine, kCubic, kClose };

  void move_to(const Eigen::Vector2d& p) { add(Verb::kMove, p); }
  void line_to(const Eigen::Vector2d& p) { add(Verb::kLine, p); }
  void cubic_to(const Eigen::Vector2d& c1, const Eigen::Vector2d& c2, const Eigen::Vector2d& p) {
    add(Verb::kCubic, c1);
    points_.push_back(c2);
    points_.push_back(p);
  }
  void close() { verbs_.push_back(Verb::kClose); }

  const std::vector<Verb>& verbs() const noexcept { return verbs_; }
  /// One point a move or line, three a cubic, none a close, in the order of the verbs.
  const std::vector<Eigen::Vector2d>& points() const noexcept { return points_; }

 private:
  void add(Verb verb, const Eigen::Vector2d& p) {
    verbs_.push_back(verb);
    points_.push_back(p);
  }

  std::vector<Verb> verbs_;
  std::vector<Eigen::Vector2d> points_;
};

}  // namespace limn
