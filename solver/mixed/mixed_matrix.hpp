#pragma once

/// The matrix of the mixed elements: symmetric, with an unknown for each face whose pressure is not
/// always prescribed. Its entries are T N_a . N_b / V of each element, plus storage on the
/// diagonal. The two sides of a leaky wall are coupled by its conductance.

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"
#include "grid/parallel.hpp"
#include "linear/directional_factor.hpp"
#include "linear/sparse_entries.hpp"
#include "mixed/flow.hpp"

namespace suffuse {

/// The linear law q = mobility factor (drive - grad p) of each element.
template <int Dim>
struct MomentumLaw {
  std::vector<double> mobility;                ///< T, m3 s/kg
  std::vector<DirectionalFactor<Dim>> factor;  ///< of bedding and fast flow; empty: I everywhere
  VectorField<Dim> drive;                      ///< Pa/m

  /// The flux that a driving gradient in Pa/m causes, over the mobility.
  [[nodiscard]] Vector<Dim> directed(int e, const Vector<Dim>& push) const {
    return factor.empty() ? push : factor[e].times(push);
  }
  /// Mobility in the best direction, m3 s/kg.
  [[nodiscard]] double best_mobility(int e) const {
    return mobility[e] * (factor.empty() ? 1.0 : factor[e].largest_eigenvalue());
  }
};

template <int Dim>
class MixedMatrix {
 public:
  /// `kinds`: per face, for the whole run.
  MixedMatrix(const Grid<Dim>& grid, const std::vector<FaceKind>& kinds, int threads)
      : grid_(grid), threads_(threads), products_(grid.mesh.elements.size()) {
    lay_out(kinds);
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      // A uniform pressure causes no flux: rows add up to zero exactly, not up to round-off.
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

  [[nodiscard]] int unknowns() const { return unknowns_; }
  /// Number of a face's unknown; -1 where its pressure is always prescribed.
  [[nodiscard]] int unknown(int face) const { return unknown_[face]; }
  [[nodiscard]] const std::vector<int>& unknowns_of_faces() const { return unknown_; }

  /// Assembles a law and the storage of each element at each of its faces, m3/(s Pa): `storage` per
  /// element, in addition `side_storage` per side of an element, and `mean_storage`, which acts on
  /// the mean pressure of an element (both may be empty).
  void assemble(const MomentumLaw<Dim>& law, const std::vector<double>& storage,
                const ElementField<Dim>& side_storage = {},
                const std::vector<double>& mean_storage = {}) {
    constexpr double share = 1.0 / ((Dim + 1) * (Dim + 1));
    const auto in_mean = [&](int e) {
      return mean_storage.empty() ? 0.0 : share * mean_storage[e];
    };
    // An off-diagonal entry belongs to the one element that has both faces; a diagonal one is the
    // sum over the two neighbors of the face.
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
  /// Couples the faces of a wall; call after `assemble`. The flux between them is the conductance
  /// times the difference of their pressures.
  void couple(const LeakyFace& wall) {
    double* values = values_.valuePtr();
    const int row = unknown_[wall.face];
    const int column = unknown_[wall.partner];
    values[slot_of(values_, row, row)] += wall.conductance;
    values[slot_of(values_, column, column)] += wall.conductance;
    values[slot_of(values_, row, column)] = values[slot_of(values_, column, row)] =
        -wall.conductance;
  }
  /// Uncouples the unknown of a face from all others.
  void uncouple(int face) {
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
  /// The values, with the derivative of each element's conductivity by the pressures at its sides:
  /// `flux` out of it by each side, m3/s, grows by the share `gain` per pressure, 1/Pa. The part on
  /// the diagonal where liquid enters was assembled already. Faces that are `held` keep their
  /// uncoupled rows. Not symmetric.
  [[nodiscard]] Eigen::SparseMatrix<double> with_gain(const ElementField<Dim>& flux,
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
  /// Doubles the diagonal at the first face of an element where nothing else fixes the level of the
  /// pressure: its rise is then zero, as the rest of the system adds up to zero.
  void hold_level(int element) { values_.valuePtr()[position_[element][0][0]] *= 2.0; }
  [[nodiscard]] const Eigen::SparseMatrix<double>& values() const { return values_; }

  /// Largest N_a . N_a / V of an element, m.
  [[nodiscard]] double largest_product(int element) const {
    double largest = 0.0;
    for (int k = 0; k <= Dim; ++k) largest = std::max(largest, products_[element][k][k]);
    return largest;
  }

 private:
  template <class Value>
  using PerEntry = std::vector<std::array<std::array<Value, Dim + 1>, Dim + 1>>;

  /// Numbers the unknowns and lays out the pattern.
  void lay_out(const std::vector<FaceKind>& kinds) {
    const int elements = grid_.mesh.element_count();
    unknown_.assign(kinds.size(), -1);
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
          position_[e][a][b] = row >= 0 && column >= 0 ? slot_of(values_, row, column) : -1;
        }
      }
    }
  }
  /// Not inlined, so that the product is rounded before anything is added to it.
  [[nodiscard, gnu::noinline]] double entry(const MomentumLaw<Dim>& law, int e, int a,
                                            int b) const {
    double product = products_[e][a][b];
    if (!law.factor.empty()) {
      product += law.factor[e].excess(grid_.outward_normal(e, a), grid_.outward_normal(e, b)) /
                 grid_.volume[e];
    }
    return product * law.mobility[e];
  }

  const Grid<Dim>& grid_;
  int threads_;
  std::vector<int> unknown_;
  int unknowns_ = 0;
  Eigen::SparseMatrix<double> values_;
  PerEntry<int> position_;     ///< index of an element's entry among the values; -1 for none
  PerEntry<double> products_;  ///< N_a . N_b / V
};

}  // namespace suffuse
