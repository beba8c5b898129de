#include "formulation/boundary_accounts.hpp"

#include <algorithm>

#include "boundary/face_conditions.hpp"
#include "files/table_files.hpp"

namespace suffuse {

template <int Dim>
BoundaryAccounts<Dim>::BoundaryAccounts(const Case<Dim>& c, const Grid<Dim>& grid)
    : grid_(grid), names_(booked_boundaries(c.document.scene)), sums_(names_.size()) {
  for (const FaceCondition& condition : face_conditions(c, grid)) {
    account_.push_back(condition.boundary);
  }
  // Leaky walls follow the boundaries. Liquid leaves the model through one of their faces and
  // enters through its partner.
  for (std::size_t k = c.document.scene.boundaries.size(); k < names_.size(); ++k) {
    for (const BoundarySet<Dim>& set : c.mesh.boundaries) {
      if (set.name != names_[k]) continue;
      for (const auto& nodes : set.faces) account_[grid.find_face(nodes)] = static_cast<int>(k);
    }
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f) || !grid.owns_face(f)) account_[f] = -1;
    if (account_[f] >= 0) faces_.push_back({f, account_[f]});
  }
}

template <int Dim>
void BoundaryAccounts<Dim>::book(int face, double water, double fines) {
  if (account_[face] < 0) return;
  Sums& sums = sums_[account_[face]];
  sums.water.add(water);
  sums.fines.add(fines);
}

template <int Dim>
void BoundaryAccounts<Dim>::book(const std::vector<double>& water,
                                 const std::vector<double>& fines) {
  for (const AccountFace& outer : faces_) book(outer.face, water[outer.face], fines[outer.face]);
}

template <int Dim>
void BoundaryAccounts<Dim>::book_liquid(const std::vector<double>& volumes) {
  for (const auto& [face, account] : faces_) sums_[account].liquid.add(volumes[face]);
}

template <int Dim>
std::vector<BoundaryRow> BoundaryAccounts<Dim>::rows(double time,
                                                     const std::vector<double>& face_flux) const {
  std::vector<ExactSum> discharge(sums_.size());
  for (const auto& [face, account] : faces_) discharge[account].add(face_flux[face]);
  std::vector<Sums> all = sums_;
  std::vector<ExactSum*> each = each_of(all);
  for (ExactSum& sum : discharge) each.push_back(&sum);
  grid_.ranks().sum(each);
  std::vector<BoundaryRow> rows;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Sums& sums = all[k];
    rows.push_back({time, names_[k], sums.water.in.value(), sums.water.out.value(),
                    sums.fines.in.value(), sums.fines.out.value(), sums.liquid.in.value(),
                    sums.liquid.out.value(), discharge[k].value()});
  }
  return rows;
}

template class BoundaryAccounts<2>;
template class BoundaryAccounts<3>;

}  // namespace suffuse
