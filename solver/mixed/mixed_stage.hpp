#pragma once

/// One implicit stage of the mixed elements: its equations, and the pressures and fluxes that its
/// solution has reached.

#include "grid/parallel.hpp"
#include "mixed/mixed_matrix.hpp"
#include "mixed/stage_faces.hpp"
#include "physics/numbers.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

/// Pressures at face centers as a sum, base + offset + rise, in which small changes of large
/// pressures have all their digits; offset = reference - base.
struct FacePressure {
  std::vector<double> reference;
  std::vector<double> offset;
  std::vector<double> rise;

  /// Moves the reference to the pressure, as nearly as its digits allow.
  void move_reference(const std::vector<double>& base) {
    for (std::size_t f = 0; f < rise.size(); ++f) {
      const double old = reference[f];
      reference[f] += rise[f];
      rise[f] -= reference[f] - old;
      offset[f] = reference[f] - base[f];
    }
  }
};

/// Initial guess of the iterations; it changes no result beyond round-off.
struct StageGuess {
  std::vector<double> rise_rate;  ///< of the last stage, per face, Pa/s
  double flux_scale = 0.0;        ///< largest flux through a face then, m3/s
};

/// A stage goes from `base` over `duration` seconds, which are infinite for a steady state.
template <int Dim>
struct MixedStage {
  /// Keeps references to its arguments. The pressures are a guess, the law is that of saturated
  /// soil without quadratic drag, and there are no fluxes yet. Throws NumericalError where the
  /// liquid meets no resistance.
  /// \param saturated  take every soil as saturated at any pressure
  MixedStage(const MixedModel<Dim>& in, const MixedMatrix<Dim>& with, StageFaces<Dim>& at,
             const MixedState<Dim>& from, double seconds, const FlowForcing<Dim>& driven_by,
             const StageGuess& guess, bool saturated)
      : model(in),
        matrix(with),
        faces(at),
        base(from),
        duration(seconds),
        forcing(driven_by),
        coefficients(forcing.coefficients),
        flux_scale(guess.flux_scale),
        retains(!saturated && model.has_retention()),
        resistance(model.grid.volume.size()),
        bedding(model.soils.bedding),
        drive(resistance.size()),
        storage(resistance.size()),
        mean_storage(forcing.mean_storage),
        net_source(forcing.source),
        expected_gradient(forcing.mean_mobility.size()),
        walls(model.walls),
        displaced(retains ? resistance.size() : 0) {
    faces.start(forcing.conditions);
    net_source.resize(resistance.size(), 0.0);
    for (double& stored : mean_storage) stored /= duration;
    find_resistance();
    bound_walls();
    guess_pressure(guess.rise_rate);
    law.mobility.resize(resistance.size());
    law.factor = bedding;
    law.drive = drive;
    for_each_element([&](int e) { set_mobility(e, 1.0 / resistance[e]); });
    if (retains && model.soils.air_moves() && !is_steady()) share_source();
  }

  void for_each_element(const auto& body) const {
    for_each_index(model.grid.mesh.element_count(), model.settings.threads, body);
  }
  void for_each_face(const auto& body) const {
    for_each_index(model.grid.face_count(), model.settings.threads, body);
  }
  /// The largest value of all elements or faces; 0 where none is larger. A rank looks at its own
  /// faces: what comes from both sides of a face is not complete at others.
  [[nodiscard]] double largest_of_elements(const auto& value) const {
    const int elements = model.grid.mesh.element_count();
    return largest_of_all(model.grid.ranks(),
                          largest_of(elements, model.settings.threads, 0.0, value));
  }
  [[nodiscard]] double largest_of_faces(const auto& value) const {
    const int first = *model.grid.own_faces().begin();
    const int own = *model.grid.own_faces().end() - first;
    return largest_of_all(model.grid.ranks(), largest_of(own, model.settings.threads, 0.0,
                                                         [&](int i) { return value(first + i); }));
  }
  /// Whether the equations depend on the pressure itself, through retention or seepage faces.
  [[nodiscard]] bool is_nonlinear() const { return retains || faces.any_switch(); }
  [[nodiscard]] bool is_steady() const { return !std::isfinite(duration); }
  /// Whether an element stores liquid as its pressure rises.
  [[nodiscard]] bool stores(int e) const {
    return storage[e] > 0.0 || (!mean_storage.empty() && mean_storage[e] > 0.0);
  }
  /// Liquid that the mean storage of an element takes up, m3/s, at these rises at its faces.
  [[nodiscard]] double stored_in_mean(int e, const auto& rise_of_face) const {
    if (mean_storage.empty()) return 0.0;
    double sum = 0.0;
    for (const int f : model.grid.element_face[e]) sum += rise_of_face(f);
    return mean_storage[e] * (sum / (Dim + 1) - forcing.known_rise[e]);
  }
  /// Liquid that the share of a side stores as its pressure rises by `rise`, m3/s.
  [[nodiscard]] double stored(int e, int k, double rise) const {
    const auto risen = [&](int f) { return pressure.offset[f] + pressure.rise[f]; };
    const double compressed = storage[e] * rise + stored_in_mean(e, risen) / (Dim + 1);
    return displaced.empty() ? compressed : compressed + displaced[e][k];
  }
  /// Flux out of an element through a side whose pressure rises by `rise`, m3/s.
  [[nodiscard]] double flux_out(int e, int k, double rise) const {
    return flux[e].dot(model.grid.outward_normal(e, k)) - stored(e, k, rise) + side_source(e, k);
  }
  /// The part of an element's source in the share of a side, m3/s.
  [[nodiscard]] double side_source(int e, int k) const {
    return moved_source.empty() ? net_source[e] / (Dim + 1) : moved_source[e][k];
  }
  /// Rate at which liquid displaces air in the share of a side that ends with `air`, m3, in m3/s.
  [[nodiscard]] double displacement_rate(int e, int k, double air) const {
    return is_steady() ? 0.0 : (base.air[e][k] - air) / duration;
  }
  [[nodiscard]] double inflow(int f) const { return faces.inflow(f, coefficients.porosity); }
  /// Flux per pressure, m3/(s Pa), through the element's largest face.
  [[nodiscard]] double conductance_of(int e) const {
    return law.best_mobility(e) * matrix.largest_product(e);
  }
  /// Sets an element's mobility (Darcy's plus the additional one), m3 s/kg, and its drive.
  void set_mobility(int e, double of_darcy) {
    law.mobility[e] = of_darcy;
    if (expected_gradient.empty()) return;
    const double additional = forcing.mean_mobility[e];
    law.mobility[e] += additional;
    law.drive[e] = (of_darcy * drive[e] + additional * expected_gradient[e]) / law.mobility[e];
  }
  /// Rise of the pressures over the base, per face, Pa.
  [[nodiscard]] std::vector<double> rise() const {
    std::vector<double> result(pressure.rise.size());
    for_each_face([&](int f) { result[f] = pressure.offset[f] + pressure.rise[f]; });
    return result;
  }
  /// Flux of each element at the pressures found.
  [[nodiscard]] VectorField<Dim> found_flux() const {
    VectorField<Dim> found(resistance.size());
    for_each_element([&](int e) {
      const Vector<Dim> gradient = model.pressure_gradient(e, pressure.reference, pressure.rise);
      found[e] = law.mobility[e] * law.directed(e, law.drive[e] - gradient);
    });
    return found;
  }

  const MixedModel<Dim>& model;
  const MixedMatrix<Dim>& matrix;
  StageFaces<Dim>& faces;
  const MixedState<Dim>& base;
  const double duration;
  const FlowForcing<Dim>& forcing;
  const FlowCoefficients<Dim>& coefficients;
  const double flux_scale;  ///< largest flux through a face in the last stage, m3/s
  const bool retains;       ///< some soil holds liquid under suction

  std::vector<double> resistance;               ///< linear, along bedding, kg/(m3 s)
  std::vector<DirectionalFactor<Dim>> bedding;  ///< mobility over that along bedding; may be empty
  VectorField<Dim> drive;                       ///< without pressure, Pa/m
  std::vector<double> storage;                  ///< per face of the element, m3/(s Pa)
  std::vector<double> mean_storage;             ///< of mean pressures, m3/(s Pa); may be empty
  std::vector<double> net_source;               ///< prescribed outflow, m3/s
  ElementField<Dim> moved_source;      ///< its share per side where air moves; empty: equal shares
  VectorField<Dim> expected_gradient;  ///< that of the additional mobility, Pa/m; may be empty
  std::vector<LeakyFace> walls;        ///< with the bounded conductance of this stage

  FacePressure pressure;
  MomentumLaw<Dim> law;
  VectorField<Dim> flux;  ///< per element, m/s
  /// Rate at which liquid displaces air at each side, m3/s; empty where all soil is saturated.
  ElementField<Dim> displaced;

 private:
  /// All sides of soil have equal parts. In free space they give by what they hold, and take by
  /// their room: a dry side has nothing to give.
  void share_source() {
    moved_source.resize(net_source.size());
    for_each_element([&](int e) {
      const double pores = coefficients.porosity[e] * model.grid.volume[e] / (Dim + 1);
      double sum = 0.0;
      for (int k = 0; k <= Dim; ++k) {
        const double free = net_source[e] > 0.0 ? base.air[e][k] : pores - base.air[e][k];
        sum += moved_source[e][k] = std::max(0.0, free);
      }
      const double soil = sum > 0.0 ? model.soils.soil_share[e] : 1.0;
      for (double& part : moved_source[e]) {
        part = net_source[e] * std::lerp(soil < 1.0 ? part / sum : 0.0, 1.0 / (Dim + 1), soil);
      }
    });
  }
  /// Linear resistance, drive and storage of each element.
  void find_resistance() {
    const FlowCoefficients<Dim>& c = coefficients;
    for_each_element([&](int e) {
      const double inertia = model.settings.inertia ? c.mixture_density[e] / duration : 0.0;
      resistance[e] = (inertia + c.drag[e]) / c.porosity[e];
      if (inertia > 0.0 && !bedding.empty()) {
        bedding[e] = bedding[e].beside_isotropic(c.drag[e] / (inertia + c.drag[e]));
      }
      drive[e] = c.mixture_density[e] * model.gravity;
      if (!forcing.force.empty()) drive[e] += forcing.force[e];
      if (inertia > 0.0) drive[e] += inertia * base.velocity[e];
      storage[e] = c.water_volume[e] / (model.settings.bulk_modulus * (Dim + 1) * duration);
      if (expected_gradient.empty()) return;
      expected_gradient[e] = model.pressure_gradient(e, base.face_pressure, forcing.expected_rise);
    });
    together(model.grid.ranks(), [&] {
      for (std::size_t e = 0; e < resistance.size(); ++e) {
        if (resistance[e] > 0.0 && std::isfinite(resistance[e])) continue;
        throw NumericalError("the liquid must meet resistance everywhere; " +
                             element_text(model.grid, static_cast<int>(e)) + " has " +
                             shown_number(resistance[e]) + " kg/(m3 s) per flux");
      }
    });
  }
  /// Bounds the conductance of walls by 1e6 times that of their elements: such a wall is no
  /// obstacle, and a larger value would drown the elements' conductances in round-off.
  void bound_walls() {
    constexpr double most_of_elements = 1e6;
    for (LeakyFace& wall : walls) {
      double of_element = 0.0;
      for (const int f : {wall.face, wall.partner}) {
        const int e = model.grid.face_left[f];
        of_element = std::max(of_element, matrix.largest_product(e) / resistance[e]);
      }
      wall.conductance = std::min(wall.conductance, most_of_elements * of_element);
    }
  }
  void guess_pressure(const std::vector<double>& rise_rate) {
    const auto expected = [&](int f) {
      if (is_steady() || (retains && forcing.expected_rise.empty())) return 0.0;
      return retains ? forcing.expected_rise[f] : rise_rate[f] * duration;
    };
    pressure.reference = base.face_pressure;
    pressure.offset.assign(base.face_pressure.size(), 0.0);
    pressure.rise.resize(base.face_pressure.size());
    for_each_face([&](int f) {
      pressure.rise[f] = expected(f);
      if (faces.is_held(f)) pressure.rise[f] = faces.condition(f).value - base.face_pressure[f];
    });
  }
};

}  // namespace suffuse
