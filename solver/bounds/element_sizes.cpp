#include "bounds/element_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace suffuse {
namespace {

constexpr double most_refined = 0.35;
constexpr double most_coarsened = 1.5;

/// Size of each element over the one before it, where each is to have the error `of_each`.
template <int Dim>
std::vector<double> changes(const std::vector<double>& error, double of_each) {
  std::vector<double> result;
  for (const double now : error) {
    const double change = std::pow(of_each / now, 1.0 / (Dim + 2));
    result.push_back(now > 0.0 ? std::clamp(change, most_refined, most_coarsened) : most_coarsened);
  }
  return result;
}

/// The largest number below which `is_small` holds.
double last_with(const auto& is_small) {
  double low = 1e-300;
  double high = 1e300;
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    (is_small(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

template <int Dim>
std::vector<double> element_sizes(const Grid<Dim>& grid) {
  std::vector<double> result;
  for (const double volume : grid.volume) {
    result.push_back(Dim == 2 ? std::sqrt(4.0 * volume / std::numbers::sqrt3)
                              : std::cbrt(6.0 * std::numbers::sqrt2 * volume));
  }
  return result;
}

template <int Dim>
std::vector<double> next_sizes(const Grid<Dim>& grid, const std::vector<double>& error,
                               const WantedError& wanted) {
  const auto whole_error = [&](double of_each) {
    const std::vector<double> change = changes<Dim>(error, of_each);
    double sum = 0.0;
    for (std::size_t e = 0; e < error.size(); ++e) sum += error[e] * change[e] * change[e];
    return sum;
  };
  const auto elements = [&](double of_each) {
    double sum = 0.0;
    for (const double change : changes<Dim>(error, of_each)) sum += std::pow(change, -Dim);
    return sum;
  };
  const double accurate = last_with([&](double t) { return whole_error(t) <= wanted.whole; });
  const double affordable = last_with([&](double t) { return elements(t) > wanted.max_elements; });
  const std::vector<double> change = changes<Dim>(error, std::max(accurate, affordable));
  std::vector<double> size(grid.mesh.node_count(), std::numeric_limits<double>::infinity());
  const std::vector<double> now = element_sizes(grid);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (const int i : grid.mesh.elements[e]) size[i] = std::min(size[i], change[e] * now[e]);
  }
  return size;
}

template std::vector<double> element_sizes(const Grid<2>&);
template std::vector<double> element_sizes(const Grid<3>&);
template std::vector<double> next_sizes(const Grid<2>&, const std::vector<double>&,
                                        const WantedError&);
template std::vector<double> next_sizes(const Grid<3>&, const std::vector<double>&,
                                        const WantedError&);

}  // namespace suffuse
