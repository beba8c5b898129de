#pragma once

/// The result of an implicit stage: fluxes through faces that balance in every element to the last
/// digits, and the air in each element that follows from them.

#include "mixed/mixed_stage.hpp"
#include "mixed/side_states.hpp"

namespace suffuse {

/// Air in the elements at these pressures, m3; empty where all soil is saturated.
template <int Dim>
ElementField<Dim> air_at(const MixedModel<Dim>& model, const std::vector<double>& face_pressure,
                         const std::vector<double>& porosity) {
  const Grid<Dim>& grid = model.grid;
  ElementField<Dim> air(model.soils.saturated() ? 0 : grid.mesh.elements.size());
  if (air.empty()) return air;
  const SideStates<Dim> sides(model, face_pressure);
  for_each_index(static_cast<int>(air.size()), model.settings.threads, [&](int e) {
    const double share = porosity[e] * grid.volume[e] / (Dim + 1);
    for (int k = 0; k <= Dim; ++k) {
      air[e][k] = share * (1.0 - sides.at(e, k).saturation);
    }
  });
  return air;
}

template <int Dim>
struct StageEnd {
  /// \param rise_of_face  of the pressures over the base of the stage, per face, Pa
  StageEnd(MixedStage<Dim>& stage, std::vector<double> rise_of_face)
      : rise(std::move(rise_of_face)), face_flux(rise.size()) {
    const MixedModel<Dim>& model = stage.model;
    const Grid<Dim>& grid = model.grid;
    const std::vector<double>& porosity = stage.coefficients.porosity;
    state.face_pressure.resize(rise.size());
    stage.for_each_face([&](int f) {
      state.face_pressure[f] = stage.faces.is_held(f) ? stage.faces.condition(f).value
                                                      : stage.base.face_pressure[f] + rise[f];
    });
    if (stage.retains) state.air = air_at(model, state.face_pressure, porosity);
    find_face_flux(stage);
    flux_through = face_flux;
    stage.for_each_face([&](int f) {
      if (!stage.faces.is_held(f)) return;
      const int e = grid.face_left[f];
      flux_through[f] += stage.stored(e, grid.side_of(e, f), rise[f]);
    });
    if (stage.retains && !stage.is_steady()) settle_air(stage);
    state.velocity.resize(stage.flux.size());
    stage.for_each_element([&](int e) { state.velocity[e] = stage.flux[e] / porosity[e]; });
  }

  std::vector<double> rise;
  MixedState<Dim> state;
  std::vector<double> face_flux;     ///< along each face's normal, m3/s
  std::vector<double> flux_through;  ///< see MixedStep

 private:
  void find_face_flux(MixedStage<Dim>& stage) {
    const MixedModel<Dim>& model = stage.model;
    const Grid<Dim>& grid = model.grid;
    std::vector<double> conductance(stage.flux.size());  // mobility over volume
    std::vector<double> net_outflow(stage.flux.size());
    stage.for_each_element([&](int e) {
      const double trace = stage.law.factor.empty() ? Dim : stage.law.factor[e].trace();
      conductance[e] = stage.law.mobility[e] * trace / grid.volume[e];
      net_outflow[e] =
          stage.net_source[e] - stage.stored_in_mean(e, [&](int f) { return rise[f]; });
      for (int k = 0; k <= Dim; ++k) {
        const int f = grid.element_face[e][k];
        net_outflow[e] -= stage.storage[e] * rise[f];
        if (stage.displaced.empty()) continue;
        stage.displaced[e][k] = stage.displacement_rate(e, k, state.air[e][k]);
        net_outflow[e] -= stage.displaced[e][k];
      }
    });
    const auto out_of = [&](int e, int f) {
      return stage.flux_out(e, grid.side_of(e, f), rise[f]);
    };
    // Use the side that conducts less, where pressures give fluxes with more digits.
    stage.for_each_face([&](int f) {
      if (stage.faces.condition(f).fixes_flux()) {
        face_flux[f] = -stage.inflow(f);
        return;
      }
      const int left = grid.face_left[f];
      const int right = grid.face_right[f];
      const int e = right < 0 || conductance[left] <= conductance[right] ? left : right;
      face_flux[f] = e == left ? out_of(e, f) : -out_of(e, f);
    });
    const FacePressure& p = stage.pressure;
    for (const LeakyFace& wall : stage.walls) {
      const int left = grid.face_left[wall.face];
      const int right = grid.face_left[wall.partner];
      const double area = model.face_area[wall.face];
      const double of_left = conductance[left] * area * area;
      const double of_right = conductance[right] * area * area;
      if (wall.conductance <= std::min(of_left, of_right)) {
        face_flux[wall.face] =
            wall.conductance * ((p.reference[wall.face] - p.reference[wall.partner]) +
                                (p.rise[wall.face] - p.rise[wall.partner]));
      } else {
        face_flux[wall.face] =
            of_left <= of_right ? out_of(left, wall.face) : -out_of(right, wall.partner);
      }
      face_flux[wall.partner] = -face_flux[wall.face];
    }
    stage.faces.correction().follow(conductance);
    stage.faces.correction().correct(face_flux, net_outflow);
  }

  /// Corrects the air in each element to what the fluxes leave there, exactly.
  void settle_air(const MixedStage<Dim>& stage) {
    const Grid<Dim>& grid = stage.model.grid;
    stage.for_each_element([&](int e) {
      // Difference between the air by the pressures and the air by the fluxes: round-off, or what
      // the iteration missed in a piece without an outlet.
      double missing = -stage.net_source[e] * stage.duration;
      missing += stage.duration * stage.stored_in_mean(e, [&](int f) { return rise[f]; });
      for (int k = 0; k <= Dim; ++k) {
        const int f = grid.element_face[e][k];
        missing += stage.duration *
                   (grid.element_face_sign[e][k] * face_flux[f] + stage.storage[e] * rise[f]);
        missing += stage.base.air[e][k] - state.air[e][k];
      }
      for (double& air : state.air[e]) air += missing / (Dim + 1);
    });
  }
};

}  // namespace suffuse
