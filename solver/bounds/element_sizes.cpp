#include "bounds/element_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/numbers.hpp"

namespace suffuse {
namespace {

constexpr double most_refined = 0.35;
constexpr double most_coarsened = 1.5;
constexpr int bisections = 60;  ///< of the logarithm of a factor: to more digits than matter

/// Size of each element over the one before it, from its error to the power -1 / (Dim + 2); the
/// factor is that power of the error that each is to have, inverted.
double change(double factor, double of_error) {
  return std::clamp(factor * of_error, most_refined, most_coarsened);
}

/// The largest number below which `is_small` holds.
double last_with(const auto& is_small) {
  double low = 1e-100;
  double high = 1e100;
  for (int i = 0; i < bisections; ++i) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    (is_small(middle) ? low : high) = middle;
  }
  return low;
}

/// Enlarges sizes that would make more elements than allowed: those at nodes are the smallest of
/// the elements around. `now`: sizes of the elements that are there, m.
template <int Dim>
void fit_number(const Grid<Dim>& grid, const std::vector<double>& now, double most,
                std::vector<double>& size) {
  double count = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double mean = 0.0;
    for (const int i : grid.mesh.elements[e]) mean += size[i] / (Dim + 1);
    count += std::pow(now[e] / mean, Dim);
  }
  const double factor = std::pow(std::max(1.0, count / most), 1.0 / Dim);
  for (double& of_node : size) of_node *= factor;
}

}  // namespace

template <int Dim>
std::vector<double> element_sizes(const Grid<Dim>& grid) {
  std::vector<double> result;
  result.reserve(grid.volume.size());
  for (const double volume : grid.volume) {
    result.push_back(Dim == 2 ? std::sqrt(4.0 * volume / std::numbers::sqrt3)
                              : std::cbrt(6.0 * std::numbers::sqrt2 * volume));
  }
  return result;
}

template <int Dim>
std::vector<double> next_sizes(const Grid<Dim>& grid, const std::vector<double>& error,
                               const WantedError& wanted) {
  std::vector<double> of_error;
  of_error.reserve(error.size());
  for (const double now : error) {
    // Zero: as large as it may become, whatever the factor.
    of_error.push_back(now > 0.0 ? std::pow(now, -1.0 / (Dim + 2)) : infinity);
  }
  const auto sum = [&](const auto& term) {
    double result = 0.0;
    for (std::size_t e = 0; e < error.size(); ++e) result += term(e);
    return result;
  };
  const double accurate = last_with([&](double factor) {
    return sum([&](std::size_t e) {
             const double c = change(factor, of_error[e]);
             return error[e] * c * c;
           }) <= wanted.whole;
  });
  const double affordable = last_with([&](double factor) {
    return sum([&](std::size_t e) {
             const double c = change(factor, of_error[e]);
             return 1.0 / (Dim == 2 ? c * c : c * c * c);
           }) > wanted.max_elements;
  });
  const double factor = std::max(accurate, affordable);
  std::vector<double> size(grid.mesh.node_count(), std::numeric_limits<double>::infinity());
  const std::vector<double> now = element_sizes(grid);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (const int i : grid.mesh.elements[e])
      size[i] = std::min(size[i], change(factor, of_error[e]) * now[e]);
  }
  fit_number(grid, now, wanted.max_elements, size);
  return size;
}

template std::vector<double> element_sizes(const Grid<2>&);
template std::vector<double> element_sizes(const Grid<3>&);
template std::vector<double> next_sizes(const Grid<2>&, const std::vector<double>&,
                                        const WantedError&);
template std::vector<double> next_sizes(const Grid<3>&, const std::vector<double>&,
                                        const WantedError&);

}  // namespace suffuse
