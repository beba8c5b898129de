#include "values/specimen.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "common/errors.hpp"

namespace suffuse {
namespace {

bool has_law(const Soil& soil) {
  return soil.erosion.law->erodes();
}

/// Places in an element that stand for equal parts of its volume and integrate quadratics exactly:
/// the midpoints of the edges of a triangle; in a tetrahedron four points between centroid and
/// corners.
template <int Dim>
std::array<Vector<Dim>, Dim + 1> equal_parts(const Mesh<Dim>& mesh, int element) {
  constexpr double inward[2] = {-0.5, 0.44721359549995794};  // from the centroid to a corner
  const Vector<Dim> centroid = element_centroid(mesh, element);
  std::array<Vector<Dim>, Dim + 1> places;
  for (int a = 0; a <= Dim; ++a) {
    const Vector<Dim>& corner = mesh.nodes[mesh.elements[element][a]];
    places.at(a) = centroid + inward[Dim - 2] * (corner - centroid);
  }
  return places;
}

/// A region of uniform soil becomes one portion.
template <int Dim>
void add_element(std::map<std::pair<std::string, double>, Portion>& portions, const Mesh<Dim>& mesh,
                 int element, const Soil& soil) {
  const double volume = element_volume(mesh, element);
  for (const Vector<Dim>& place : equal_parts(mesh, element)) {
    const double porosity = soil.initial_porosity(place);
    auto& portion = portions[{soil.region, porosity}];
    portion.soil = soil;
    portion.initial_porosity = porosity;
    portion.volume += volume / (Dim + 1);
  }
}

template <int Dim>
Specimen specimen_of(const Scene& scene, const Mesh<Dim>& mesh) {
  const bool any = std::any_of(scene.soils.begin(), scene.soils.end(), has_law);
  const bool any_exchanges = std::ranges::any_of(scene.soils, &Soil::exchanges);
  Specimen found;
  found.starts_from_scene = scene.initial_from.empty();
  std::vector<const Soil*> soils;
  for (int r = 0; r < static_cast<int>(mesh.region_names.size()); ++r) {
    const Soil* soil = scene.find_soil(mesh.region_names[r]);
    const bool counts = soil != nullptr && (has_law(*soil) || !any);
    soils.push_back(counts ? soil : nullptr);
    if (counts) found.regions.push_back(r);
    if (soil == nullptr) continue;
    if (!counts) found.has_all_soil = false;
    if (counts != (soil->exchanges() || !any_exchanges)) found.has_mean_of_history = false;
  }
  std::map<std::pair<std::string, double>, Portion> portions;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Soil* soil = soils[mesh.element_region[e]];
    if (soil != nullptr) add_element(portions, mesh, e, *soil);
  }
  for (const auto& [key, portion] : portions) {
    found.portions.push_back(portion);
    found.volume += portion.volume;
  }
  return found;
}

}  // namespace

Specimen specimen(const ResultsReader& run) {
  return with_mesh(run, [&](const auto& mesh) { return specimen_of(run.scene().scene, mesh); });
}

std::string specimen_name(bool has_all_soil) {
  return has_all_soil ? "the soil" : "the soil that erodes";
}

double integrate(const Specimen& specimen, double t,
                 const std::function<double(const Soil&, double, double)>& density) {
  double total = 0.0;
  for (const auto& portion : specimen.portions) {
    const double now =
        exact_porosity(portion.soil.erosion_model(), portion.initial_porosity, t, unset);
    total += portion.volume * density(portion.soil, portion.initial_porosity, now);
  }
  return total;
}

bool has_exact_porosity(const Specimen& specimen) {
  return specimen.starts_from_scene && std::ranges::all_of(specimen.portions, [](const Portion& p) {
           return has_exact_porosity(p.soil.erosion_model()) && !p.soil.deposition.deposits() &&
                  !p.soil.skeleton.moves();
         });
}

double exact_mean_porosity(const Specimen& specimen, double t) {
  return integrate(specimen, t, [](const Soil&, double, double now) { return now; }) /
         specimen.volume;
}

double exact_exhaustion(const Specimen& specimen) {
  double last = 0.0;
  for (const auto& portion : specimen.portions) {
    last = std::max(last, exhaustion_time(portion.soil.erosion_model(), portion.initial_porosity));
  }
  return last;
}

std::vector<Masses> computed_masses(const ResultsReader& run, const Specimen& specimen) {
  const Table table = run.region_ledgers();
  require_curve(run, table, "regions.csv");
  std::map<double, Masses> masses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto at = [&](const char* name) { return table.column(name)[row]; };
    const auto region = static_cast<int>(at("region"));
    if (std::ranges::find(specimen.regions, region) == specimen.regions.end()) continue;
    auto& m = masses[at("t")];
    m.t = at("t");
    m.solid += at("solid");
    m.erodible += at("erodible");
    m.eroded += at("eroded");
    m.liquid += at("water") + at("fines") + (at("water_out") + at("fines_out")) -
                (at("water_in") + at("fines_in"));
    m.fines += at("fines");
    if (table.has("pending")) m.pending += at("pending");
    m.water_out += at("water_out");
    m.fines_out += at("fines_out");
    m.fines_in += at("fines_in");
  }
  std::vector<Masses> ascending;
  ascending.reserve(masses.size());
  for (const auto& [t, m] : masses) ascending.push_back(m);
  return ascending;
}

Masses exact_masses(const Specimen& specimen, double water_density, double t) {
  Masses m;
  m.t = t;
  m.solid = integrate(
      specimen, t, [](const Soil& s, double, double now) { return (1.0 - now) * s.grain_density; });
  m.erodible = integrate(specimen, t, [](const Soil& s, double, double now) {
    return (s.porosity_max() - now) * s.grain_density;
  });
  m.eroded = integrate(specimen, t, [](const Soil& s, double before, double now) {
    return (now - before) * s.grain_density;
  });
  m.liquid = m.eroded + integrate(specimen, t, [&](const Soil& s, double before, double) {
               return s.drains() ? unset : before * water_density;
             });
  return m;
}

void require_curve(const ResultsReader& run, const Table& table, const std::string& name) {
  const auto& t = table.column("t");
  if (t.empty() || !(t.back() > t.front())) {
    throw FileError(run.folder() + ": " + name + " has no two times yet to draw a curve through");
  }
}

}  // namespace suffuse
