#include "checks/filter_checks.hpp"

#include <map>

#include "checks/face_vector.hpp"
#include "checks/filter_criteria.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

/// Volume that flows from one region into another, m3/s, by the numbers of the regions.
using Exchanges = std::map<std::pair<int, int>, double>;

template <int Dim>
Exchanges flows_between(const Mesh<Dim>& mesh, const std::vector<double>& flux) {
  struct Side {
    int element;
    Vector<Dim> outward;
  };
  std::map<std::array<int, Dim>, Side> open;
  Exchanges flows;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      const auto key = face_key<Dim>(face_opposite<Dim>(mesh.elements[e], a));
      const auto found = open.find(key);
      if (found == open.end()) {
        open.emplace(key, Side{e, face_vector<Dim>(mesh, e, a)});
        continue;
      }
      const Side side = found->second;
      open.erase(found);
      const int from = mesh.element_region[side.element];
      const int to = mesh.element_region[e];
      if (from == to) continue;
      const auto q = [&](int element) {
        return Vector<Dim>::Map(&flux[Dim * static_cast<std::size_t>(element)]);
      };
      const double volume = 0.5 * (q(side.element) + q(e)).dot(side.outward);
      if (from < to) {
        flows[{from, to}] += volume;
      } else {
        flows[{to, from}] -= volume;
      }
    }
  }
  return flows;
}

std::string class_of(double d15, const ErosionBoundaries& boundaries) {
  if (d15 <= boundaries.none) return "no erosion";
  if (d15 > boundaries.continuing) return "continuing erosion";
  if (!boundaries.excessive) return "some or excessive erosion: the boundary between is a chart";
  return d15 <= *boundaries.excessive ? "some erosion" : "excessive erosion";
}

CheckRow ratio_row(const std::string& mechanism, const std::string& where, const std::string& what,
                   double effect, double resistance) {
  CheckRow row{.mechanism = mechanism, .where = where, .clause = "Terzaghi, " + what};
  row.effect = effect;
  row.resistance = resistance;
  row.unit = "1";
  row.factor = resistance / effect;
  return row;
}

void add_pair(std::vector<CheckRow>& rows, const Soil& base, const Soil& filter) {
  const std::string where = base.region + " -> " + filter.region;
  const auto d15 = size_at(filter.gradation, 15.0);
  if (!d15) {
    CheckRow row{.mechanism = "filter", .where = where, .clause = "Foster and Fell (2001)"};
    row.note = "D15 of " + filter.region + " is below the sizes of its gradation: not judged";
    rows.push_back(row);
    return;
  }
  const ErosionBoundaries boundaries = erosion_boundaries(base.gradation);
  CheckRow row{.mechanism = "filter", .where = where, .clause = "Foster and Fell (2001)"};
  row.effect = *d15;
  row.resistance = boundaries.none;
  row.unit = "mm";
  row.factor = boundaries.none / *d15;
  row.note =
      class_of(*d15, boundaries) + "; D15 = " + short_text(*d15) + " mm, boundaries " +
      short_text(boundaries.none) + " (none)" +
      (boundaries.excessive ? ", " + short_text(*boundaries.excessive) + " (excessive)" : "") +
      ", " + short_text(boundaries.continuing) + " mm (continuing)";
  rows.push_back(row);
  if (const auto ratio = retention_ratio(base.gradation, filter.gradation)) {
    rows.push_back(
        ratio_row("filter-retention", where, "D15F / D85B <= 4", *ratio, terzaghi_ratio));
  }
  if (const auto ratio = drainage_ratio(base.gradation, filter.gradation)) {
    rows.push_back(ratio_row("filter-drainage", where, "D15F / D15B >= 4", terzaghi_ratio, *ratio));
  }
}

}  // namespace

std::vector<CheckRow> filter_checks(const ResultsReader& results) {
  const Scene& scene = results.scene().scene;
  const std::size_t last = results.times().size() - 1;
  const std::vector<double> flux = results.field(last, "cell", "darcy_flux").values;
  const Exchanges flows =
      with_mesh(results, [&](const auto& mesh) { return flows_between(mesh, flux); });
  std::vector<CheckRow> rows;
  for (const auto& [pair, volume] : flows) {
    const Soil* first = scene.find_soil(results.regions()[pair.first]);
    const Soil* second = scene.find_soil(results.regions()[pair.second]);
    if (first == nullptr || second == nullptr || volume == 0.0) continue;
    if (first->gradation.empty() || second->gradation.empty()) continue;
    if (volume > 0.0) {
      add_pair(rows, *first, *second);
    } else {
      add_pair(rows, *second, *first);
    }
  }
  return rows;
}

}  // namespace suffuse
