/// Flow of the mixed elements through walls: conductance times the difference of the pressures on
/// the two sides, which are unknowns of their own.

#include <algorithm>
#include <cmath>

#include "mixed/implicit_mixed.hpp"
#include "physics/numbers.hpp"

namespace suffuse {
namespace {

/// A wall that conducts so much better than the elements beside it hinders nothing, while its
/// conductance would hide theirs in the matrix.
constexpr double most_of_elements = 1e6;

}  // namespace

template <int Dim>
void ImplicitMixed<Dim>::find_wall_conductance() {
  work_.walls = walls_;
  for (LeakyFace& wall : work_.walls) {
    double beside = 0.0;
    for (const int f : {wall.face, wall.partner}) {
      const int e = grid_.face_left[f];
      beside = std::max(beside, matrix_.largest_product(e) / work_.resistance[e]);
    }
    wall.conductance = std::min(wall.conductance, most_of_elements * beside);
  }
}

template <int Dim>
void ImplicitMixed<Dim>::add_walls_to_load() {
  const std::vector<double>& reference = work_.pressure.reference;
  for (const LeakyFace& wall : work_.walls) {
    const double flux = wall.conductance * (reference[wall.face] - reference[wall.partner]);
    work_.load[matrix_.unknown(wall.face)] -= flux;
    work_.load[matrix_.unknown(wall.partner)] += flux;
    for (const int f : {wall.face, wall.partner}) {
      work_.tolerance[matrix_.unknown(f)] += 2.0 * epsilon * std::abs(flux);
    }
  }
}

template <int Dim>
double ImplicitMixed<Dim>::wall_round_off() const {
  double largest = 0.0;
  for (const LeakyFace& wall : work_.walls) {
    for (const int f : {wall.face, wall.partner}) {
      largest = std::max(largest, epsilon * wall.conductance * std::abs(work_.pressure.rise[f]));
    }
  }
  return largest;
}

template <int Dim>
double ImplicitMixed<Dim>::wall_flux(const LeakyFace& wall, double out_of_left,
                                     double out_of_partner) const {
  // From what conducts least, where pressures give fluxes with more digits.
  const FacePressure& p = work_.pressure;
  const double difference = (p.reference[wall.face] - p.reference[wall.partner]) +
                            (p.rise[wall.face] - p.rise[wall.partner]);
  const double area = face_area_[wall.face];
  const double left = work_.conductance[grid_.face_left[wall.face]] * area * area;
  const double right = work_.conductance[grid_.face_left[wall.partner]] * area * area;
  if (wall.conductance <= std::min(left, right)) return wall.conductance * difference;
  return left <= right ? out_of_left : -out_of_partner;
}

template void ImplicitMixed<2>::find_wall_conductance();
template void ImplicitMixed<2>::add_walls_to_load();
template double ImplicitMixed<2>::wall_round_off() const;
template double ImplicitMixed<2>::wall_flux(const LeakyFace&, double, double) const;
template void ImplicitMixed<3>::find_wall_conductance();
template void ImplicitMixed<3>::add_walls_to_load();
template double ImplicitMixed<3>::wall_round_off() const;
template double ImplicitMixed<3>::wall_flux(const LeakyFace&, double, double) const;

}  // namespace suffuse
