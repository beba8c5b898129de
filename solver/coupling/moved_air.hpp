#pragma once

/// Motion of water and air in the pores of moving soil (docs/theory/moving-soil.md, "Air and
/// soil that moves").

#include <optional>
#include <vector>

#include "grid/grid.hpp"
#include "mixed/implicit_mixed.hpp"
#include "motion/motion_step.hpp"

namespace suffuse {

/// What elements hold before a motion.
struct ElementPores {
  std::vector<double> porosity;    ///< of water and air
  std::vector<double> soil_share;  ///< of the pores, see `FlowSoils`; empty if no air moves
  /// Volume between the outer boundary of the mesh and soil that has sunk below it, without water
  /// outside, m3. It is not part of the pores; negative where soil has swelled beyond the boundary.
  std::vector<double> gap;
};

/// \param without_solid  share of each element that no solid fills
/// \param porosity       of water and air, per element
template <int Dim>
ElementPores element_pores(const Grid<Dim>& grid, std::vector<double> without_solid,
                           std::vector<double> porosity, std::vector<double> soil_share);

/// An element whose gap is nearly as large as it can be; none if there is none. As the soil moves
/// on, air comes into its pores, or leaves them.
template <int Dim>
std::optional<int> element_with_full_gap(const Grid<Dim>& grid, const ElementPores& pores);

/// Solid and water that cross faces with moving soil, with the porosity and the saturation of the
/// element that they come from.
template <int Dim>
class MovedAir {
 public:
  /// \param flow         before the motion, with air
  /// \param face_volume  of soil, S_f, along the normal of each face, m3
  MovedAir(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
           const MixedState<Dim>& flow, ElementPores pores, const std::vector<double>& face_volume);

  /// Solid and water, m3: the soil without its air.
  [[nodiscard]] double without_air(int face) const { return solid_[face] + water_[face]; }
  /// Growth of an element's pores as this solid leaves it, m3.
  [[nodiscard]] double pores_gained(int e) const;
  /// Growth of an element's room as it takes in this solid, m3, and as its gap closes.
  [[nodiscard]] double room_gained(int e, double solid) const;
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
  std::vector<double> solid_;  ///< per face, m3; at outer faces what the gap takes
  std::vector<double> water_;  ///< per face, m3
};

/// Adds the water that moved with the soil to the volumes of `step`, which are relative to the
/// soil. Sets the air to that after the motion.
/// Returns the growth of each element's room for water and air, m3.
/// \param motion  committed
/// \param flow    before the step
/// \param pores   before the motion
template <int Dim>
std::vector<double> move_liquid(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                                const SolidMotion& motion, const MixedState<Dim>& flow,
                                ElementPores pores, MixedStep<Dim>& step);

/// S of each element.
template <int Dim>
std::vector<double> saturation_of(const Grid<Dim>& grid, const ElementField<Dim>& air,
                                  const std::vector<double>& porosity);

}  // namespace suffuse
