#include "motion/solid_flux.hpp"

#include <cmath>

namespace suffuse {

template <int Dim>
std::vector<double> smooth_volumes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                   const std::vector<double>& solid_volume,
                                   const std::vector<char>& rigid) {
  const std::vector<double> share = node_shares(grid, points, solid_volume, rigid);
  std::vector<double> result(grid.mesh.element_count(), 0.0);
  if (!rigid.empty()) {
    for (int p = 0; p < points.size(); ++p) {
      if (rigid[points.element[p]] != 0) result[points.element[p]] += solid_volume[p];
    }
  }
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!rigid.empty() && rigid[e] != 0) continue;
    for (const int i : grid.mesh.elements[e]) result[e] += grid.volume[e] / (Dim + 1) * share[i];
  }
  return result;
}

template <int Dim>
void SolidFlux<Dim>::follow(const std::vector<char>& has_solid) {
  if (has_solid == has_solid_) return;
  has_solid_ = has_solid;
  find_pieces();
  factorise();
}

template <int Dim>
void SolidFlux<Dim>::find_pieces() {
  const int count = grid_.mesh.element_count();
  piece_.assign(count, -1);
  drain_.assign(count, -1);
  roots_.clear();
  from_root_.clear();
  for (int root = 0; root < count; ++root) {
    if (has_solid_[root] == 0 || piece_[root] >= 0) continue;
    piece_[root] = piece_count();
    roots_.push_back(root);
    from_root_.push_back(root);
    for (std::size_t i = from_root_.size() - 1; i < from_root_.size(); ++i) {
      const int e = from_root_[i];
      for (int k = 0; k <= Dim; ++k) {
        const int next = grid_.across(e, k);
        if (next < 0 || has_solid_[next] == 0 || piece_[next] >= 0) continue;
        piece_[next] = piece_[root];
        drain_[next] = grid_.element_face[e][k];
        from_root_.push_back(next);
      }
    }
  }
}

/// Factorizes the graph of the elements. The potential is zero at the roots.
template <int Dim>
void SolidFlux<Dim>::factorise() {
  int count = 0;
  unknown_.assign(grid_.mesh.element_count(), -1);
  for (const int e : from_root_) {
    if (drain_[e] >= 0) unknown_[e] = count++;
  }
  conductance_.assign(grid_.face_count(), 0.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!is_passable(f)) continue;
    const int left = grid_.face_left[f];
    const int right = grid_.face_right[f];
    conductance_[f] =
        grid_.face_normal[f].squaredNorm() / (grid_.volume[left] + grid_.volume[right]);
    for (const int a : {left, right}) {
      for (const int b : {left, right}) {
        if (unknown_[a] < 0 || unknown_[b] < 0) continue;
        entries.emplace_back(unknown_[a], unknown_[b], a == b ? conductance_[f] : -conductance_[f]);
      }
    }
  }
  factor_.reset();
  if (count == 0) return;
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<CholeskyFactor>();
  factor_->factorise(matrix);
}

template <int Dim>
std::vector<double> SolidFlux<Dim>::carried(const std::vector<double>& face_volume,
                                            const std::vector<double>& solid_volume) const {
  std::vector<double> result(grid_.face_count(), 0.0);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!is_passable(f)) continue;
    const int from = face_volume[f] > 0.0 ? grid_.face_left[f] : grid_.face_right[f];
    result[f] = face_volume[f] * solid_volume[from] / grid_.volume[from];
  }
  return result;
}

/// Outflow of each element plus its gain, m3.
template <int Dim>
std::vector<double> SolidFlux<Dim>::excess(const std::vector<double>& gain,
                                           const std::vector<double>& face_volume) const {
  std::vector<double> result = gain;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (int k = 0; k <= Dim; ++k) {
      result[e] += grid_.element_face_sign[e][k] * face_volume[grid_.element_face[e][k]];
    }
  }
  return result;
}

template <int Dim>
double SolidFlux<Dim>::balance(const std::vector<double>& gain, std::vector<double>& face_volume) {
  double there = 0.0;
  for (const double v : face_volume) there += std::abs(v);
  double added = 0.0;
  if (factor_) {
    const std::vector<double> before = excess(gain, face_volume);
    Eigen::VectorXd rhs(static_cast<int>(from_root_.size() - roots_.size()));
    for (const int e : from_root_) {
      if (unknown_[e] >= 0) rhs[unknown_[e]] = -before[e];
    }
    Eigen::VectorXd potential;
    factor_->solve(rhs, potential);
    const auto at = [&](int e) { return unknown_[e] < 0 ? 0.0 : potential[unknown_[e]]; };
    for (int f = 0; f < grid_.face_count(); ++f) {
      if (conductance_[f] == 0.0) continue;
      const double more = conductance_[f] * (at(grid_.face_left[f]) - at(grid_.face_right[f]));
      face_volume[f] += more;
      added += std::abs(more);
    }
  }
  // Correct the last digits along a tree.
  std::vector<double> rest = excess(gain, face_volume);
  for (std::size_t i = from_root_.size(); i-- > 0;) {
    const int e = from_root_[i];
    const int f = drain_[e];
    if (f < 0) continue;
    const bool is_left = grid_.face_left[f] == e;
    face_volume[f] -= is_left ? rest[e] : -rest[e];
    rest[is_left ? grid_.face_right[f] : grid_.face_left[f]] += rest[e];
  }
  return there > 0.0 ? added / there : 0.0;
}

template std::vector<double> smooth_volumes(const Grid<2>&, const SolidPoints<2>&,
                                            const std::vector<double>&, const std::vector<char>&);
template std::vector<double> smooth_volumes(const Grid<3>&, const SolidPoints<3>&,
                                            const std::vector<double>&, const std::vector<char>&);
template class SolidFlux<2>;
template class SolidFlux<3>;

}  // namespace suffuse
