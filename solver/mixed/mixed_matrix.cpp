#include "mixed/mixed_matrix.hpp"

#include <algorithm>

#include "grid/parallel.hpp"

namespace suffuse {

template <int Dim>
MixedMatrix<Dim>::MixedMatrix(const Grid<Dim>& grid, int threads)
    : grid_(grid), threads_(threads), products_(grid.mesh.elements.size()) {
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    // Rows add up to zero, as pressure alone moves nothing: better so than by round-off.
    auto& products = products_[e];
    for (int a = 0; a <= Dim; ++a) {
      products[a][a] = 0.0;
      for (int b = 0; b < a; ++b) {
        products[a][b] = products[b][a] =
            grid.outward_normal(e, a).dot(grid.outward_normal(e, b)) / grid.volume[e];
      }
    }
    for (int a = 0; a <= Dim; ++a) {
      double others = 0.0;
      for (int b = 0; b <= Dim; ++b) {
        if (b != a) others += products[a][b];
      }
      products[a][a] = -others;
    }
  }
}

template <int Dim>
void MixedMatrix<Dim>::lay_out(const std::vector<FaceKind>& kinds) {
  const int elements = grid_.mesh.element_count();
  unknown_.assign(kinds.size(), -1);
  unknowns_ = 0;
  for (std::size_t f = 0; f < kinds.size(); ++f) {
    if (kinds[f] != FaceKind::pressure) unknown_[f] = unknowns_++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& faces : grid_.element_face) {
    for (const int f : faces) {
      for (const int g : faces) {
        if (unknown_[f] >= 0 && unknown_[g] >= 0) {
          entries.emplace_back(unknown_[f], unknown_[g], 1.0);
        }
      }
    }
  }
  for (std::size_t f = 0; f < kinds.size(); ++f) {
    const int partner = grid_.face_partner[f];
    if (partner >= 0) entries.emplace_back(unknown_[f], unknown_[partner], 1.0);
  }
  values_.resize(unknowns_, unknowns_);
  values_.setFromTriplets(entries.begin(), entries.end());
  values_.makeCompressed();

  position_.resize(elements);
  for (int e = 0; e < elements; ++e) {
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b <= Dim; ++b) {
        const int row = unknown_[grid_.element_face[e][a]];
        const int column = unknown_[grid_.element_face[e][b]];
        position_[e][a][b] = row >= 0 && column >= 0 ? position(row, column) : -1;
      }
    }
  }
}

template <int Dim>
int MixedMatrix<Dim>::position(int row, int column) const {
  const int* inner = values_.innerIndexPtr();
  const int* first = inner + values_.outerIndexPtr()[column];
  const int* last = inner + values_.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - inner);
}

template <int Dim>
double MixedMatrix<Dim>::entry(const MomentumLaw<Dim>& law, int e, int a, int b) const {
  double product = products_[e][a][b];
  if (!law.factor.empty()) {
    product += law.factor[e].excess(grid_.outward_normal(e, a), grid_.outward_normal(e, b)) /
               grid_.volume[e];
  }
  return product * law.mobility[e];
}

template <int Dim>
void MixedMatrix<Dim>::assemble(const MomentumLaw<Dim>& law, const std::vector<double>& storage,
                                const ElementField<Dim>& side_storage,
                                const std::vector<double>& mean_storage) {
  constexpr double share = 1.0 / ((Dim + 1) * (Dim + 1));
  const auto in_mean = [&](int e) { return mean_storage.empty() ? 0.0 : share * mean_storage[e]; };
  // An entry beside the diagonal belongs to the one element that has both faces; to those on the
  // diagonal both neighbours of the face add.
  double* values = values_.valuePtr();
  for_each_index(grid_.mesh.element_count(), threads_, [&](int e) {
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b <= Dim; ++b) {
        if (a == b || position_[e][a][b] < 0) continue;
        values[position_[e][a][b]] = entry(law, e, a, b) + in_mean(e);
      }
    }
  });
  for_each_index(grid_.face_count(), threads_, [&](int f) {
    if (unknown_[f] < 0) return;
    const auto diagonal = [&](int e) {
      const int k = grid_.side_of(e, f);
      const double stored = side_storage.empty() ? storage[e] : storage[e] + side_storage[e][k];
      return entry(law, e, k, k) + stored + in_mean(e);
    };
    const int left = grid_.face_left[f];
    const int k = grid_.side_of(left, f);
    values[position_[left][k][k]] =
        grid_.is_outer(f) ? diagonal(left) : diagonal(left) + diagonal(grid_.face_right[f]);
  });
}

template <int Dim>
void MixedMatrix<Dim>::couple(const LeakyFace& wall) {
  double* values = values_.valuePtr();
  const int row = unknown_[wall.face];
  const int column = unknown_[wall.partner];
  values[position(row, row)] += wall.conductance;
  values[position(column, column)] += wall.conductance;
  values[position(row, column)] = values[position(column, row)] = -wall.conductance;
}

template <int Dim>
void MixedMatrix<Dim>::uncouple(int face) {
  double* values = values_.valuePtr();
  for (const int e : {grid_.face_left[face], grid_.face_right[face]}) {
    if (e < 0) continue;
    const int k = grid_.side_of(e, face);
    for (int b = 0; b <= Dim; ++b) {
      if (b == k || position_[e][k][b] < 0) continue;
      values[position_[e][k][b]] = values[position_[e][b][k]] = 0.0;
    }
  }
}

template <int Dim>
Eigen::SparseMatrix<double> MixedMatrix<Dim>::with_gain(const ElementField<Dim>& flux,
                                                        const ElementField<Dim>& gain,
                                                        const std::vector<char>& held) const {
  Eigen::SparseMatrix<double> result = values_;
  double* values = result.valuePtr();
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const auto& faces = grid_.element_face[e];
    for (int a = 0; a <= Dim; ++a) {
      for (int b = 0; b <= Dim; ++b) {
        if (position_[e][a][b] < 0 || held[faces[a]] != 0 || held[faces[b]] != 0) continue;
        const double grows = flux[e][a] * gain[e][b];
        values[position_[e][a][b]] -= a == b ? std::max(0.0, grows) : grows;
      }
    }
  }
  return result;
}

template <int Dim>
double MixedMatrix<Dim>::largest_product(int element) const {
  double largest = 0.0;
  for (int k = 0; k <= Dim; ++k) largest = std::max(largest, products_[element][k][k]);
  return largest;
}

template class MixedMatrix<2>;
template class MixedMatrix<3>;

}  // namespace suffuse
