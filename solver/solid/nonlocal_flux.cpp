#include "solid/nonlocal_flux.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

/// Least weight, for soil that had no fines from the start.
constexpr double least_weight = 1e-6;
/// Mean weight below which a node is without fines around it: the flux there does not matter, and
/// is that of the point that asks.
constexpr double without_fines = 1e-3;
/// Residual of the linear systems over their right-hand side.
constexpr double tolerance = 1e-12;

}  // namespace

template <int Dim>
NonlocalFlux<Dim>::NonlocalFlux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads)
    : grid_(grid), soils_(soils), solver_(threads, {}, flow_factor(Dim, grid.face_count())) {
  number_nodes();
  assemble();
  if (grid.ranks().count() > 1) shared_.emplace(grid.ranks(), grid.node_rows(), unknown_);
  weight_.resize(soils.points().size());
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

  const MaterialPoints<Dim>& points = soils_.points();
  entries.clear();
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    if (length(e) == 0.0) continue;
    for (int a = 0; a <= Dim; ++a) {
      entries.emplace_back(unknown_[grid_.mesh.elements[e][a]], p, points.barycentric[p][a]);
    }
  }
  shape_.resize(count_, points.size());
  shape_.setFromTriplets(entries.begin(), entries.end());
}

template <int Dim>
auto NonlocalFlux<Dim>::smoothed(const Values& source) -> Values {
  const Eigen::Map<const Values> volume(soils_.points().volume.data(), source.size());
  const Values at_nodes = shape_ * source.cwiseProduct(volume);
  const double most = largest_of_all(grid_.ranks(), at_nodes.lpNorm<Eigen::Infinity>());
  // The guess is not an earlier solution, as a resumed run has none.
  const Values guess = Values::Zero(count_);
  const Values allowed = Values::Constant(count_, tolerance * most);
  const SymmetricSystem system{matrix_, at_nodes, guess, allowed};
  return shared_ ? shared_->solve(system) : solver_.solve(system);
}

template <int Dim>
void NonlocalFlux<Dim>::find_weight(const std::vector<double>& fines_left) {
  // An interval asks several times with the same fines.
  if (!any_of_all(grid_.ranks(), fines_left != fines_left_)) return;
  fines_left_ = fines_left;
  for (std::size_t p = 0; p < fines_left.size(); ++p) {
    weight_[p] = std::max(fines_left[p], least_weight);
  }
  mean_weight_ = smoothed(weight_);
}

template <int Dim>
void NonlocalFlux<Dim>::find(const std::vector<double>& fines_left, PointFlows& flows) {
  find_weight(fines_left);
  const Values flux = Eigen::Map<const Values>(flows.flux.data(), weight_.size());
  // Means undershoot zero where angles are obtuse.
  const Values mean =
      smoothed(weight_.cwiseProduct(flux)).cwiseQuotient(mean_weight_).cwiseMax(0.0);
  flows.eroding_flux = flows.flux;
  for (int p = 0; p < soils_.points().size(); ++p) {
    if (length(soils_.points().element[p]) == 0.0) continue;
    if (!flows.flux_change.empty()) flows.flux_change[p] = 0.0;
    double sum = 0.0;
    for (Eigen::SparseMatrix<double>::InnerIterator it(shape_, p); it; ++it) {
      sum += it.value() * (mean_weight_[it.row()] > without_fines ? mean[it.row()] : flux[p]);
    }
    flows.eroding_flux[p] = sum;
  }
}

template class NonlocalFlux<2>;
template class NonlocalFlux<3>;

}  // namespace suffuse
