#include "seeding.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "case/errors.hpp"

namespace suffuse {

namespace {

using Rule = std::vector<QuadraturePoint<2>>;

/// The three points with two coordinates equal to `a`.
void add_three(Rule& rule, double weight, double a) {
  const double b = 1.0 - 2.0 * a;
  rule.push_back({{b, a, a}, weight});
  rule.push_back({{a, b, a}, weight});
  rule.push_back({{a, a, b}, weight});
}

/// The six permutations of three different coordinates.
void add_six(Rule& rule, double weight, double a, double b) {
  std::array<double, 3> coordinates{a, b, 1.0 - a - b};
  std::ranges::sort(coordinates);
  do {
    rule.push_back({coordinates, weight});
  } while (std::ranges::next_permutation(coordinates).found);
}

Rule twelve_points() {
  Rule rule;
  add_three(rule, 0.11678627572637936603, 0.24928674517091042129);
  add_three(rule, 0.050844906370206816921, 0.06308901449150222834);
  add_six(rule, 0.082851075618373575194, 0.053145049844816947353, 0.31035245103378440542);
  return rule;
}

/// Uniform numbers from a fixed recipe: std::uniform_real_distribution differs between libraries.
class UniformNumbers {
 public:
  explicit UniformNumbers(int seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  /// In [0, 1).
  double next() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }
  /// Uniform in angle; by rejection, because sine and cosine differ between libraries.
  Vector<2> direction() {
    for (;;) {
      const double x = 2.0 * next() - 1.0;
      const double y = 2.0 * next() - 1.0;
      const Vector<2> v(x, y);
      const double square = v.squaredNorm();
      if (square > 0.0 && square <= 1.0) return v / std::sqrt(square);
    }
  }

 private:
  std::mt19937_64 engine_;
};

class Jitter {
 public:
  Jitter(const Mesh<2>& mesh, const PointSettings& settings)
      : mesh_(mesh), fraction_(settings.jitter), random_(settings.seed) {}

  void move(int element, std::array<double, 3>& barycentric) {
    const std::array<double, 3> slope = slopes(element, random_.direction());
    double distance = fraction_ * std::sqrt(2.0 * element_volume(mesh_, element));
    for (int a = 0; a < 3; ++a) {
      if (slope[a] < 0.0) distance = std::min(distance, barycentric[a] / -slope[a]);
    }
    distance *= random_.next();
    for (int a = 0; a < 3; ++a) barycentric[a] += distance * slope[a];
  }

 private:
  /// Change of the barycentric coordinates per length in `direction`.
  [[nodiscard]] std::array<double, 3> slopes(int element, const Vector<2>& direction) const {
    const auto& corners = mesh_.elements[element];
    Eigen::Matrix2d edges;
    edges.col(0) = mesh_.nodes[corners[1]] - mesh_.nodes[corners[0]];
    edges.col(1) = mesh_.nodes[corners[2]] - mesh_.nodes[corners[0]];
    const Vector<2> slope = edges.inverse() * direction;
    return {-slope[0] - slope[1], slope[0], slope[1]};
  }

  const Mesh<2>& mesh_;
  double fraction_;
  UniformNumbers random_;
};

}  // namespace

Rule triangle_rule(int count) {
  Rule rule;
  switch (count) {
    case 1:
      rule.push_back({{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 1.0});
      return rule;
    case 3:
      add_three(rule, 1.0 / 3.0, 1.0 / 6.0);
      return rule;
    case 6:
      add_three(rule, 0.2233815896780114657, 0.44594849091596488632);
      add_three(rule, 0.10995174365532186764, 0.09157621350977074346);
      return rule;
    case 12:
      return twelve_points();
    default:
      throw InputError("points.solid_per_element: got " + std::to_string(count) +
                       "; expected 1, 3, 6 or 12");
  }
}

MaterialPoints<2> seed_solid_points(const Mesh<2>& mesh, const PointSettings& settings) {
  const Rule rule = triangle_rule(settings.solid_per_element);
  Jitter jitter(mesh, settings);
  MaterialPoints<2> points;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double volume = element_volume(mesh, e);
    for (const QuadraturePoint<2>& at : rule) {
      points.element.push_back(e);
      points.barycentric.push_back(at.barycentric);
      points.volume.push_back(at.weight * volume);
      if (settings.jitter > 0.0) jitter.move(e, points.barycentric.back());
    }
  }
  return points;
}

}  // namespace suffuse
