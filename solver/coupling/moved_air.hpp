#pragma once

/// Soil that moves takes the water and the air in its pores along (docs/theory.md, "Air beside soil
/// that moves").

#include <vector>

#include "grid/grid.hpp"
#include "mixed/implicit_mixed.hpp"
#include "motion/motion_step.hpp"

namespace suffuse {

/// What crosses faces with soil that moves, if it has the porosity and the saturation of the
/// element that it comes from.
template <int Dim>
class MovedAir {
 public:
  /// \param air          before the motion, per side of each element, m3; not empty
  /// \param porosity     per element
  /// \param face_volume  of soil, S_f, along the normal of each face, m3
  MovedAir(const Grid<Dim>& grid, const ElementField<Dim>& air, const std::vector<double>& porosity,
           const std::vector<double>& face_volume);

  /// Solid and water, m3: what is left of the soil without its air.
  [[nodiscard]] double without_air(int face) const { return solid_[face] + water_[face]; }
  /// Growth of the pores of an element as that solid leaves it, m3.
  [[nodiscard]] double pores_gained(int e) const;
  /// Water that crosses a face as solid does, m3: with what crosses beyond the solid assumed here,
  /// as much water goes the other way as the element that takes it in has in its pores.
  /// \param solid       s_f, m3
  /// \param saturation  per element, after the flow
  [[nodiscard]] double water(int face, double solid, const std::vector<double>& saturation) const;

 private:
  /// Value of `of_element` in the element that takes in `volume`, m3, which crosses a face along
  /// its normal.
  [[nodiscard]] double taken_in(int face, double volume,
                                const std::vector<double>& of_element) const;

  const Grid<Dim>& grid_;
  std::vector<double> solid_;  ///< per face, m3
  std::vector<double> water_;  ///< per face, m3
};

/// Adds to what crossed the faces in `step`, of the flow relative to the soil, the water that moved
/// with the soil; its air becomes that after the motion.
/// \param motion    committed
/// \param air       before the step, per side of each element, m3; empty where there is none
/// \param porosity  per element, before the motion
template <int Dim>
void move_liquid(const Grid<Dim>& grid, const SolidMotion& motion, const ElementField<Dim>& air,
                 std::vector<double> porosity, MixedStep<Dim>& step);

/// S of each element.
template <int Dim>
std::vector<double> saturation_of(const Grid<Dim>& grid, const ElementField<Dim>& air,
                                  const std::vector<double>& porosity);

}  // namespace suffuse
