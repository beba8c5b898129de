#include "seeding.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "common/errors.hpp"

namespace suffuse {

namespace {

template <int Dim>
using Rule = std::vector<QuadraturePoint<Dim>>;

/// The three points with two coordinates equal to `a`.
void add_three(Rule<2>& rule, double weight, double a) {
  const double b = 1.0 - 2.0 * a;
  rule.push_back({{b, a, a}, weight});
  rule.push_back({{a, b, a}, weight});
  rule.push_back({{a, a, b}, weight});
}

/// The six permutations of three different coordinates.
void add_six(Rule<2>& rule, double weight, double a, double b) {
  std::array<double, 3> coordinates{a, b, 1.0 - a - b};
  std::ranges::sort(coordinates);
  do {
    rule.push_back({coordinates, weight});
  } while (std::ranges::next_permutation(coordinates).found);
}

Rule<2> twelve_points() {
  Rule<2> rule;
  add_three(rule, 0.11678627572637936603, 0.24928674517091042129);
  add_three(rule, 0.050844906370206816921, 0.06308901449150222834);
  add_six(rule, 0.082851075618373575194, 0.053145049844816947353, 0.31035245103378440542);
  return rule;
}

/// The four points of a tetrahedron with three coordinates equal to `a`.
void add_four(Rule<3>& rule, double weight, double a) {
  for (int k = 0; k < 4; ++k) {
    std::array<double, 4> at{a, a, a, a};
    at[k] = 1.0 - 3.0 * a;
    rule.push_back({at, weight});
  }
}

/// The six points of a tetrahedron with two coordinates equal to `a` and two equal to 1/2 - a.
void add_six(Rule<3>& rule, double weight, double a) {
  std::array<double, 4> at{a, a, 0.5 - a, 0.5 - a};
  std::ranges::sort(at);
  do {
    rule.push_back({at, weight});
  } while (std::ranges::next_permutation(at).found);
}

Rule<3> fourteen_points() {
  Rule<3> rule;
  add_four(rule, 0.11268792571801585080, 0.31088591926330060980);
  add_four(rule, 0.073493043116361949544, 0.092735250310891226402);
  add_six(rule, 0.042546020777081466438, 0.045503704125649649492);
  return rule;
}

/// Uniform numbers by a fixed algorithm: std::uniform_real_distribution differs between libraries.
class UniformNumbers {
 public:
  /// The streams of one seed are independent.
  explicit UniformNumbers(int seed, std::uint64_t stream = 0)
      : engine_(static_cast<std::uint64_t>(seed) + (stream << 32U)) {}
  /// The next number, in [0, 1).
  double next() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }
  /// A direction, uniform in angle; found by rejection, because sine and cosine differ between
  /// libraries.
  template <int Dim>
  Vector<Dim> direction() {
    for (;;) {
      Vector<Dim> v;
      for (int d = 0; d < Dim; ++d) v[d] = 2.0 * next() - 1.0;
      const double square = v.squaredNorm();
      if (square > 0.0 && square <= 1.0) return v / std::sqrt(square);
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// Cube root of a positive number by Newton's method: std::cbrt differs between libraries in the
/// last bit.
double cube_root(double x) {
  double root = std::max(1.0, x);
  for (;;) {
    const double next = root - (root - x / (root * root)) / 3.0;
    if (!(next < root)) return root;
    root = next;
  }
}

template <int Dim>
class Jitter {
 public:
  using Barycentric = std::array<double, Dim + 1>;

  Jitter(const Mesh<Dim>& mesh, const PointSettings& settings)
      : mesh_(mesh), fraction_(settings.jitter), random_(settings.seed) {}

  void move(int element, Barycentric& barycentric) {
    const Barycentric slope = slopes(element, random_.template direction<Dim>());
    double distance = fraction_ * element_size(element);
    for (int a = 0; a <= Dim; ++a) {
      if (slope[a] < 0.0) distance = std::min(distance, barycentric[a] / -slope[a]);
    }
    distance *= random_.next();
    for (int a = 0; a <= Dim; ++a) barycentric[a] += distance * slope[a];
  }

 private:
  /// Length of the equal legs of a right-angled element of this volume.
  [[nodiscard]] double element_size(int element) const {
    const double volume = element_volume(mesh_, element);
    return Dim == 2 ? std::sqrt(2.0 * volume) : cube_root(6.0 * volume);
  }

  /// Change of the barycentric coordinates per length in `direction`.
  [[nodiscard]] Barycentric slopes(int element, const Vector<Dim>& direction) const {
    const auto& corners = mesh_.elements[element];
    Eigen::Matrix<double, Dim, Dim> edges;
    for (int d = 0; d < Dim; ++d) {
      edges.col(d) = mesh_.nodes[corners[d + 1]] - mesh_.nodes[corners[0]];
    }
    const Vector<Dim> slope = edges.inverse() * direction;
    Barycentric result{};
    for (int d = 0; d < Dim; ++d) {
      result[0] -= slope[d];
      result[d + 1] = slope[d];
    }
    return result;
  }

  const Mesh<Dim>& mesh_;
  double fraction_;
  UniformNumbers random_;
};

/// Random points in an element.
template <int Dim>
class RandomPoints {
 public:
  explicit RandomPoints(int seed) : random_(seed, 1) {}
  std::array<double, Dim + 1> next() {
    double x = random_.next();
    double y = random_.next();
    if constexpr (Dim == 2) {
      if (x + y > 1.0) {  // reflect the other half of the square
        x = 1.0 - x;
        y = 1.0 - y;
      }
      return {1.0 - x - y, x, y};
    } else {
      // Distances between three numbers in ascending order, 0 and 1.
      std::array<double, 3> cuts{x, y, random_.next()};
      std::ranges::sort(cuts);
      return {cuts[0], cuts[1] - cuts[0], cuts[2] - cuts[1], 1.0 - cuts[2]};
    }
  }

 private:
  UniformNumbers random_;
};

template <int Dim>
class EvenPoints;

/// Basu and Owen's sequence: each digit of the index in base 4, the last one first, chooses one of
/// four similar triangles of the one before; the point is the centroid of the last triangle. Any
/// 4^m points from a multiple of 4^m on fall into different ones of the 4^m triangles.
template <>
class EvenPoints<2> {
 public:
  std::array<double, 3> next() {
    std::array<double, 3> point{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    // Half the distance from the centroid to a corner; the middle triangle is inverted.
    double half = 0.5;
    for (std::uint64_t rest = index_++; rest > 0; rest /= 4) {
      const std::uint64_t digit = rest % 4;
      for (std::uint64_t a = 0; a < 3 && digit > 0; ++a) {
        point[a] += half * ((a + 1 == digit ? 1.0 : 0.0) - 1.0 / 3.0);
      }
      half *= digit > 0 ? 0.5 : -0.5;
    }
    point[0] = 1.0 - point[1] - point[2];
    return point;
  }

 private:
  std::uint64_t index_ = 0;
};

/// Halton's sequence in the bases 2, 3 and 5, mapped from the cube to the tetrahedron one to one
/// and without a change of density: the cube's planes become planes parallel to a side.
template <>
class EvenPoints<3> {
 public:
  std::array<double, 4> next() {
    ++index_;
    const double a = cube_root(radical_inverse(5));
    const double b = std::sqrt(radical_inverse(3));
    const double c = radical_inverse(2);
    return {1.0 - a, a * (1.0 - b), a * b * (1.0 - c), a * b * c};
  }

 private:
  /// Number in [0, 1) with the digits of the index behind the point, in reverse order.
  [[nodiscard]] double radical_inverse(std::uint64_t base) const {
    double result = 0.0;
    double place = 1.0;
    for (std::uint64_t rest = index_; rest > 0; rest /= base) {
      place /= static_cast<double>(base);
      result += place * static_cast<double>(rest % base);
    }
    return result;
  }

  std::uint64_t index_ = 0;
};

/// Whether a place is off all sides; a point on a side would belong to two elements.
template <std::size_t N>
bool is_inside(const std::array<double, N>& barycentric) {
  constexpr double margin = 1e-9;
  return std::ranges::all_of(barycentric, [](double share) { return share > margin; });
}

template <int Dim>
double liquid_volume(const Mesh<Dim>& mesh, const Scene& scene, int element) {
  const std::string& region = mesh.region_names[mesh.element_region[element]];
  const Soil* soil = scene.find_soil(region);
  // n_0 is linear: its mean is its value at the centroid.
  const double porosity = soil ? soil->initial_porosity(element_centroid(mesh, element)) : 1.0;
  return porosity * element_volume(mesh, element);
}

/// Mean liquid volume of the elements whose soil `counts`, m3; 0 when there is none.
template <int Dim, class Counts>
double mean_liquid_volume(const Mesh<Dim>& mesh, const Scene& scene, Counts counts) {
  double sum = 0.0;
  int elements = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Soil* soil = scene.find_soil(mesh.region_names[mesh.element_region[e]]);
    if (soil == nullptr || !counts(*soil)) continue;
    sum += liquid_volume(mesh, scene, e);
    ++elements;
  }
  return elements > 0 ? sum / elements : 0.0;
}

/// Rounds to the nearest whole number, at least one. Halves are rounded down, also with round-off,
/// so that equal elements get equal numbers.
std::int64_t whole_points(double share) {
  constexpr double round_off = 1e-9;
  constexpr double most = 1e9;
  return std::max<std::int64_t>(1,
                                std::llround(std::ceil(std::min(share, most) - 0.5 - round_off)));
}

template <int Dim, class NextPoint>
void add_equal_points(MaterialPoints<Dim>& points, int element, std::int64_t count, double volume,
                      NextPoint next) {
  for (std::int64_t i = 0; i < count; ++i) {
    std::array<double, Dim + 1> at = next();
    while (!is_inside(at)) at = next();
    points.element.push_back(element);
    points.barycentric.push_back(at);
    points.volume.push_back(volume / static_cast<double>(count));
  }
}

template <int Dim>
void add_gauss_points(MaterialPoints<Dim>& points, int element, const Rule<Dim>& rule,
                      double volume) {
  for (const QuadraturePoint<Dim>& at : rule) {
    points.element.push_back(element);
    points.barycentric.push_back(at.barycentric);
    points.volume.push_back(at.weight * volume);
  }
}

template <int Dim, class IsSoil>
MaterialPoints<Dim> seed_solid_points_where(const Mesh<Dim>& mesh, const PointSettings& settings,
                                            IsSoil is_soil) {
  const Rule<Dim> rule = gauss_rule<Dim>(settings.solid_per_element);
  Jitter<Dim> jitter(mesh, settings);
  MaterialPoints<Dim> points;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!is_soil(e)) continue;
    const auto first = static_cast<std::size_t>(points.size());
    add_gauss_points(points, e, rule, element_volume(mesh, e));
    if (!(settings.jitter > 0.0)) continue;
    for (std::size_t p = first; p < points.barycentric.size(); ++p) {
      jitter.move(e, points.barycentric[p]);
    }
  }
  return points;
}

}  // namespace

template <>
Rule<2> gauss_rule<2>(int count) {
  Rule<2> rule;
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
      throw InputError("Gauss points per triangle: got " + std::to_string(count) +
                       "; expected 1, 3, 6 or 12");
  }
}

template <>
Rule<3> gauss_rule<3>(int count) {
  Rule<3> rule;
  switch (count) {
    case 1:
      rule.push_back({{0.25, 0.25, 0.25, 0.25}, 1.0});
      return rule;
    case 4:
      add_four(rule, 0.25, 0.13819660112501051518);
      return rule;
    case 14:
      return fourteen_points();
    default:
      throw InputError("Gauss points per tetrahedron: got " + std::to_string(count) +
                       "; expected 1, 4 or 14");
  }
}

template <int Dim>
MaterialPoints<Dim> seed_solid_points(const Mesh<Dim>& mesh, const PointSettings& settings) {
  return seed_solid_points_where(mesh, settings, [](int) { return true; });
}

template <int Dim>
MaterialPoints<Dim> seed_solid_points(const Mesh<Dim>& mesh, const Scene& scene) {
  return seed_solid_points_where(mesh, scene.points, [&](int element) {
    return !scene.is_free_water(mesh.region_names[mesh.element_region[element]]);
  });
}

template <int Dim>
std::vector<std::int64_t> liquid_point_counts(const Mesh<Dim>& mesh, const Scene& scene) {
  const PointSettings& settings = scene.points;
  std::vector<std::int64_t> counts(mesh.elements.size(), settings.liquid_per_element);
  if (!settings.equal_volume || settings.seeding == Seeding::gauss) return counts;
  double mean =
      mean_liquid_volume(mesh, scene, [](const Soil& soil) { return soil.erosion.law->erodes(); });
  if (mean == 0.0) mean = mean_liquid_volume(mesh, scene, [](const Soil&) { return true; });
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double elements_worth = liquid_volume(mesh, scene, e) / mean;
    counts[static_cast<std::size_t>(e)] =
        whole_points(settings.liquid_per_element * elements_worth);
  }
  return counts;
}

template <int Dim>
MaterialPoints<Dim> seed_liquid_points(const Mesh<Dim>& mesh, const Scene& scene) {
  const std::vector<std::int64_t> counts = liquid_point_counts(mesh, scene);
  const bool gauss = scene.points.seeding == Seeding::gauss;
  const Rule<Dim> rule = gauss ? gauss_rule<Dim>(scene.points.liquid_per_element) : Rule<Dim>{};
  RandomPoints<Dim> random(scene.points.seed);
  EvenPoints<Dim> even;
  MaterialPoints<Dim> points;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double volume = liquid_volume(mesh, scene, e);
    const std::int64_t count = counts[static_cast<std::size_t>(e)];
    switch (scene.points.seeding) {
      case Seeding::gauss:
        add_gauss_points(points, e, rule, volume);
        break;
      case Seeding::random:
        add_equal_points(points, e, count, volume, [&] { return random.next(); });
        break;
      case Seeding::low_discrepancy:
        add_equal_points(points, e, count, volume, [&] { return even.next(); });
        break;
    }
  }
  return points;
}

template MaterialPoints<2> seed_solid_points(const Mesh<2>&, const PointSettings&);
template MaterialPoints<3> seed_solid_points(const Mesh<3>&, const PointSettings&);
template MaterialPoints<2> seed_solid_points(const Mesh<2>&, const Scene&);
template MaterialPoints<3> seed_solid_points(const Mesh<3>&, const Scene&);
template std::vector<std::int64_t> liquid_point_counts(const Mesh<2>&, const Scene&);
template std::vector<std::int64_t> liquid_point_counts(const Mesh<3>&, const Scene&);
template MaterialPoints<2> seed_liquid_points(const Mesh<2>&, const Scene&);
template MaterialPoints<3> seed_liquid_points(const Mesh<3>&, const Scene&);

}  // namespace suffuse
