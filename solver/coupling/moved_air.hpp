#pragma once

/// Motion of water and air in the pores of moving soil (docs/theory/moving-soil.md, "Air and
/// soil that moves").

#include <vector>

#include "grid/grid.hpp"
#include "mixed/implicit_mixed.hpp"
#include "motion/motion_step.hpp"

namespace suffuse {

/// Solid and water that cross faces with moving soil, with the porosity and the saturation of the
/// element that they come from.
template <int Dim>
class MovedAir {
 public:
  /// \param flow         before the motion, with air
  /// \param porosity     per element
  /// \param soil_share   of the pores of each element, see `FlowSoils`
  /// \param face_volume  of soil, S_f, along the normal of each face, m3
  MovedAir(const Grid<Dim>& grid, const MixedState<Dim>& flow, const std::vector<double>& porosity,
           const std::vector<double>& soil_share, const std::vector<double>& face_volume);

  /// Solid and water, m3: the soil without its air.
  [[nodiscard]] double without_air(int face) const { return solid_[face] + water_[face]; }
  /// Growth of an element's pores as this solid leaves it, m3.
  [[nodiscard]] double pores_gained(int e) const;
  /// Water that crosses a face with the solid, m3. Solid beyond that assumed here displaces water
  /// by the saturation of the element that it enters.
  /// \param solid       s_f, m3
  /// \param saturation  per element, after the flow
  [[nodiscard]] double water(int face, double solid, const std::vector<double>& saturation) const;

 private:
  /// Value of `of_element` in the element that `volume`, m3, enters as it crosses a face along its
  /// normal.
  [[nodiscard]] double taken_in(int face, double volume,
                                const std::vector<double>& of_element) const;

  const Grid<Dim>& grid_;
  std::vector<double> solid_;  ///< per face, m3
  std::vector<double> water_;  ///< per face, m3
};

/// Adds the water that moved with the soil to the volumes of `step`, which are relative to the
/// soil. Sets the air to that after the motion.
/// \param motion      committed
/// \param flow        before the step
/// \param porosity    per element, before the motion
/// \param soil_share  see `MovedAir`; empty if no air moves
template <int Dim>
void move_liquid(const Grid<Dim>& grid, const SolidMotion& motion, const MixedState<Dim>& flow,
                 std::vector<double> porosity, const std::vector<double>& soil_share,
                 MixedStep<Dim>& step);

/// S of each element.
template <int Dim>
std::vector<double> saturation_of(const Grid<Dim>& grid, const ElementField<Dim>& air,
                                  const std::vector<double>& porosity);

}  // namespace suffuse
