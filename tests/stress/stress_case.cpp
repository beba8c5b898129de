#include "stress/stress_case.hpp"

#include <algorithm>
#include <sstream>

#include "case/consistency.hpp"
#include "common/errors.hpp"
#include "driver/plan.hpp"
#include "seeding.hpp"

namespace suffuse::stress {
namespace {

template <int Dim>
Case<Dim> build(const Scenario& scenario, const Span& span) {
  Case<Dim> c;
  c.document =
      parse_scene(scene_text(scenario.scheme, span.end), "stress.toml", scenario.changes(span));
  c.mesh = std::get<std::function<Mesh<Dim>()>>(scenario.mesh)();
  complete_for_mesh(c.document, Dim);
  std::vector<InputProblem> problems = scene_problems(c.document, c.mesh);
  if (!problems.empty()) throw InputError(std::move(problems));
  c.solid_points = seed_solid_points(c.mesh, c.document.scene);
  if (is_double_point(scenario.scheme)) {
    c.liquid_points = seed_liquid_points(c.mesh, c.document.scene);
  }
  return c;
}

/// Largest step that the solver accepts from the scene, read from its own message.
template <int Dim>
double limit_of_given_step(Case<Dim> c) {
  const std::string before = "expected at most ";
  c.document.scene.time.step = c.document.scene.time.end;
  try {
    return make_plan(c, {}).limit.step;
  } catch (const InputError& error) {
    const std::string text = error.what();
    const std::size_t at = text.find(before);
    if (at == std::string::npos) return 0.0;
    return std::stod(text.substr(at + before.size()));
  }
}

/// Step that the solver takes when the scene gives none; 0 where it refuses the scene.
template <int Dim>
double chosen_step(Case<Dim> c) {
  c.document.scene.time.step.reset();
  try {
    return make_plan(c, {}).flow.step;
  } catch (const InputError&) {
    return 0.0;
  }
}

}  // namespace

std::string name_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::sp_explicit:
      return "sp-explicit";
    case Scheme::sp_implicit:
      return "sp-implicit";
    case Scheme::sp_monotone:
      return "sp-monotone";
    case Scheme::dp_mixed:
      return "dp-mixed";
    case Scheme::dp_material_point:
      return "dp-material-point";
    case Scheme::dp_implicit:
      return "dp-implicit";
    case Scheme::dp_monotone:
      return "dp-monotone";
  }
  throw std::logic_error("no such scheme");
}

bool is_double_point(Scheme scheme) {
  return scheme >= Scheme::dp_mixed;
}

bool is_explicit(Scheme scheme) {
  return scheme == Scheme::sp_explicit || scheme == Scheme::dp_mixed ||
         scheme == Scheme::dp_material_point;
}

std::string scene_text(Scheme scheme, double end) {
  std::ostringstream text;
  text.precision(17);
  text << "formulation = \"" << (is_double_point(scheme) ? "double" : "single") << "-point\"\n"
       << "[geometry]\nfile = \"stress.msh\"\n"
       << "[points]\n"
       << (is_double_point(scheme) ? "liquid_per_element = 6\n" : "")
       << "[liquid]\ndensity = 1000.0\nbulk_modulus = 2.0e7\nviscosity = 1.0e-3\n"
       << "[soil.specimen]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2700.0\n"
       << "conductivity = 2.0e-2\n"
       << "[soil.specimen.erosion]\nlaw = \"constant\"\nrate = " << 0.1 / (0.6 * end)
       << "\nstart = " << 0.1 * end << "\n"
       << "[[boundary]]\non = \"top\"\npressure = 6.0e3\n"
       << "[[boundary]]\non = \"bottom\"\npressure = 0.0\n";
  if (scheme == Scheme::dp_material_point) text << "[flow]\nintegration = \"material-point\"\n";
  text << "[time]\nend = " << end << "\nscheme = \"" << (is_explicit(scheme) ? "ex" : "im")
       << "plicit\"\n";
  if (scheme == Scheme::sp_monotone || scheme == Scheme::dp_monotone) {
    text << "stepping = \"monotone\"\n";
  }
  text << "[output]\nevery = " << 0.05 * end << "\nsnapshot_every = " << 0.25 * end << "\n";
  return text.str();
}

template <int Dim>
Case<Dim> make_case(const Scenario& scenario) {
  Span span{scenario.end, 0.0};
  Case<Dim> c = build<Dim>(scenario, span);
  if (is_explicit(scenario.scheme)) {
    const double step = chosen_step(c);
    if (step > 0.0) span.end = std::min(span.end, scenario.explicit_steps * step);
    span.limit = limit_of_given_step(c);
    c = build<Dim>(scenario, span);
  }
  if constexpr (Dim == 2) {
    if (scenario.disturb) scenario.disturb(c);
  }
  return c;
}

template Case<2> make_case(const Scenario&);
template Case<3> make_case(const Scenario&);

}  // namespace suffuse::stress
