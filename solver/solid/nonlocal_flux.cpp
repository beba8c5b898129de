#include "solid/nonlocal_flux.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

/// Least weight, for soil that had no fines from the start.
constexpr double least_weight = 1e-6;
/// Mean weight below which a place is without fines: the flux there does not matter, and is that of
/// the place.
constexpr double without_fines = 1e-3;
/// Residual of the linear systems over their right-hand side.
constexpr double tolerance = 1e-12;

}  // namespace

template <int Dim>
NonlocalFlux<Dim>::NonlocalFlux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads)
    : grid_(grid), soils_(soils), solver_(threads, {}, flow_factor(Dim, grid.face_count())) {
  number_nodes();
  assemble();
  volume_ = at_nodes(std::vector<double>(soils.points().size(), 1.0));
}

template <int Dim>
void NonlocalFlux<Dim>::number_nodes() {
  unknown_.assign(grid_.mesh.node_count(), -1);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (length(e) == 0.0) continue;
    for (const int node : grid_.mesh.elements[e]) unknown_[node] = 0;
  }
  for (int& number : unknown_) {
    if (number == 0) number = count_++;
  }
}

template <int Dim>
void NonlocalFlux<Dim>::assemble() {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (length(e) == 0.0) continue;
    const double stiffness = length(e) * length(e) * grid_.volume[e];
    for (int a = 0; a <= Dim; ++a) {
      const int row = unknown_[grid_.mesh.elements[e][a]];
      entries.emplace_back(row, row, grid_.volume[e] / (Dim + 1));
      for (int b = 0; b <= Dim; ++b) {
        entries.emplace_back(
            row, unknown_[grid_.mesh.elements[e][b]],
            stiffness * grid_.shape_gradient[e][a].dot(grid_.shape_gradient[e][b]));
      }
    }
  }
  matrix_.resize(count_, count_);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

template <int Dim>
Eigen::VectorXd NonlocalFlux<Dim>::at_nodes(const std::vector<double>& values) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count_);
  const MaterialPoints<Dim>& points = soils_.points();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    if (length(e) == 0.0) continue;
    for (int a = 0; a <= Dim; ++a) {
      sum[unknown_[grid_.mesh.elements[e][a]]] +=
          points.barycentric[p][a] * points.volume[p] * values[p];
    }
  }
  return sum;
}

template <int Dim>
Eigen::VectorXd NonlocalFlux<Dim>::smoothed(const Eigen::VectorXd& source) {
  // The guess is not an earlier solution, as a resumed run has none.
  const Eigen::VectorXd guess = Eigen::VectorXd::Zero(count_);
  const Eigen::VectorXd allowed =
      Eigen::VectorXd::Constant(count_, tolerance * source.cwiseAbs().maxCoeff());
  return solver_.solve({matrix_, source, guess, allowed});
}

template <int Dim>
std::vector<double> NonlocalFlux<Dim>::at_points(const Eigen::VectorXd& nodes,
                                                 std::vector<double> values) const {
  const MaterialPoints<Dim>& points = soils_.points();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    if (length(e) == 0.0) continue;
    values[p] = 0.0;
    for (int a = 0; a <= Dim; ++a) {
      values[p] += points.barycentric[p][a] * nodes[unknown_[grid_.mesh.elements[e][a]]];
    }
  }
  return values;
}

template <int Dim>
void NonlocalFlux<Dim>::find_weight(const std::vector<double>& fines_left) {
  // An interval asks several times with the same fines.
  if (fines_left == fines_left_) return;
  fines_left_ = fines_left;
  weight_ = fines_left;
  for (double& w : weight_) w = std::max(w, least_weight);
  mean_weight_ = smoothed(at_nodes(weight_));
}

template <int Dim>
void NonlocalFlux<Dim>::find(const std::vector<double>& fines_left, PointFlows& flows) {
  find_weight(fines_left);
  const auto mean = [&](const std::vector<double>& values) {
    std::vector<double> weighted = values;
    for (std::size_t p = 0; p < weighted.size(); ++p) weighted[p] *= weight_[p];
    const Eigen::VectorXd of_fines = smoothed(at_nodes(weighted));
    const Eigen::VectorXd of_place = at_nodes(values);
    Eigen::VectorXd nodes(count_);
    for (int i = 0; i < count_; ++i) {
      nodes[i] = mean_weight_[i] > without_fines ? of_fines[i] / mean_weight_[i]
                                                 : of_place[i] / volume_[i];
    }
    return at_points(nodes, values);
  };
  flows.eroding_flux = mean(flows.flux);
  // Undershoots where angles are obtuse.
  for (double& flux : flows.eroding_flux) flux = std::max(flux, 0.0);
  if (flows.flux_change.empty()) return;
  flows.eroding_flux_change = mean(flows.flux_change);
  for (std::size_t p = 0; p < weight_.size(); ++p) {
    const double most = 2.0 * flows.eroding_flux[p];
    flows.eroding_flux_change[p] = std::clamp(flows.eroding_flux_change[p], -most, most);
  }
}

template class NonlocalFlux<2>;
template class NonlocalFlux<3>;

}  // namespace suffuse
