#include "checks/filter_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "checks/face_vector.hpp"
#include "checks/filter_criteria.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

/// Volume that flows from one region into another, m3/s, through all faces where it flows this way,
/// by the numbers of the regions.
using Exchanges = std::map<std::pair<int, int>, double>;

/// Gradient up to which water counts as still: round-off.
constexpr double still_gradient = 1e-9;
/// Share of the largest flow between soils up to which a flow counts as none.
constexpr double small_flow = 1e-6;

/// A face between two regions.
template <int Dim>
struct Contact {
  std::array<int, 2> element;
  std::array<int, 2> region;
  Vector<Dim> area;  ///< from the first to the second
};

template <int Dim>
std::vector<Contact<Dim>> contacts(const Mesh<Dim>& mesh) {
  std::map<std::array<int, Dim>, std::pair<int, int>> open;
  std::vector<Contact<Dim>> found;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      const auto key = face_key<Dim>(face_opposite<Dim>(mesh.elements[e], a));
      const auto [other, is_new] = open.try_emplace(key, e, a);
      if (is_new) continue;
      const auto [element, corner] = other->second;
      const std::array<int, 2> region{mesh.element_region[element], mesh.element_region[e]};
      if (region[0] == region[1]) continue;
      found.push_back({{element, e}, region, face_vector<Dim>(mesh, element, corner)});
    }
  }
  return found;
}

/// Keeps the largest flows of all snapshots.
template <int Dim>
void add_flows(const std::vector<Contact<Dim>>& faces, const std::vector<double>& flux,
               const std::vector<double>& still, Exchanges& largest) {
  Exchanges now;
  for (const Contact<Dim>& face : faces) {
    const auto q = [&](int element) {
      return Vector<Dim>::Map(&flux[Dim * static_cast<std::size_t>(element)]);
    };
    const double volume = 0.5 * (q(face.element[0]) + q(face.element[1])).dot(face.area);
    const double least = std::min(still[face.region[0]], still[face.region[1]]);
    if (std::abs(volume) <= least * face.area.norm()) continue;
    const auto [from, to] = face.region;
    now[volume > 0.0 ? std::pair{from, to} : std::pair{to, from}] += std::abs(volume);
  }
  for (const auto& [pair, volume] : now) largest[pair] = std::max(largest[pair], volume);
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

/// A row that says why a filter is not judged.
CheckRow row_without_factor(const std::string& where, const std::string& why) {
  CheckRow row{.mechanism = "filter", .where = where, .clause = "Foster and Fell (2001)"};
  row.note = why + ": not judged";
  return row;
}

CheckRow erosion_row(const std::string& where, double d15, const ErosionBoundaries& boundaries) {
  CheckRow row{.mechanism = "filter", .where = where, .clause = "Foster and Fell (2001)"};
  row.effect = d15;
  row.resistance = boundaries.none;
  row.unit = "mm";
  row.factor = boundaries.none / d15;
  row.note =
      class_of(d15, boundaries) + "; D15 = " + short_text(d15) + " mm, boundaries " +
      short_text(boundaries.none) + " (none)" +
      (boundaries.excessive ? ", " + short_text(*boundaries.excessive) + " (excessive)" : "") +
      ", " + short_text(boundaries.continuing) + " mm (continuing)";
  return row;
}

void add_pair(std::vector<CheckRow>& rows, const Soil& from, const Soil& filter) {
  const std::string where = from.region + " -> " + filter.region;
  const auto d15 = size_at(filter.gradation, 15.0);
  if (!d15) {
    rows.push_back(row_without_factor(
        where, "D15 of " + filter.region + " is below the sizes of its gradation"));
    return;
  }
  const FilterBase base = filter_base(from.gradation);
  const auto boundaries = erosion_boundaries(base.gradation);
  if (!boundaries) {
    rows.push_back(
        row_without_factor(where, "the gradation of " + from.region +
                                      " begins above the sizes that decide, 0.075 mm and D85"));
    return;
  }
  rows.push_back(erosion_row(where, *d15, *boundaries));
  if (base.finer < 100.0) {
    rows.back().note += "; the base is the finest " + percent_text(base.finer) + " of " +
                        from.region + ", whose coarse grains do not hold them";
  }
  if (const auto ratio = retention_ratio(base.gradation, filter.gradation)) {
    rows.push_back(
        ratio_row("filter-retention", where, "D15F / D85B <= 4", *ratio, terzaghi_ratio));
  }
  // Soil that is finer than the base holds it, and is not there to drain it.
  const auto ratio = drainage_ratio(from.gradation, filter.gradation);
  if (ratio && *ratio > 1.0) {
    rows.push_back(ratio_row("filter-drainage", where, "D15F / D15B >= 4", terzaghi_ratio, *ratio));
  }
}

}  // namespace

std::vector<CheckRow> stability_checks(const ResultsReader& results) {
  std::vector<CheckRow> rows;
  for (const std::string& region : results.regions()) {
    const Soil* soil = results.scene().scene.find_soil(region);
    if (soil == nullptr || soil->gradation.empty()) continue;
    const GradingVerdict verdict = check_kenney_lau(soil->gradation);
    CheckRow row{.mechanism = "internal-stability",
                 .where = region,
                 .clause = "Kenney and Lau (1986), H / F >= 1"};
    if (verdict.stability != Stability::unknown && std::isfinite(verdict.value)) {
      row.effect = 1.0;
      row.resistance = verdict.value;
      row.unit = "1";
      row.factor = verdict.value;
    }
    std::string others;
    for (const GradingVerdict& other : check_grading(soil->gradation)) {
      if (other.check == verdict.check) continue;
      others += (others.empty() ? "" : "; ") + other.check + ": " + stability_text(other);
    }
    row.note =
        stability_text(verdict) + (row.factor ? "; " : ", " + verdict.reason + "; ") + others;
    rows.push_back(row);
  }
  return rows;
}

std::vector<CheckRow> filter_checks(const ResultsReader& results) {
  const Scene& scene = results.scene().scene;
  std::vector<const Soil*> soils;
  std::vector<double> still;
  for (const std::string& region : results.regions()) {
    soils.push_back(scene.find_soil(region));
    still.push_back(soils.back() == nullptr ? 0.0 : still_gradient * soils.back()->conductivity);
  }
  Exchanges flows;
  with_mesh(results, [&](const auto& mesh) {
    const auto faces = contacts(mesh);
    for (std::size_t i = 0; i < results.times().size(); ++i) {
      add_flows(faces, results.field(i, "cell", "darcy_flux").values, still, flows);
    }
  });
  double largest = 0.0;
  for (const auto& [pair, volume] : flows) largest = std::max(largest, volume);
  std::vector<CheckRow> rows;
  for (const auto& [pair, volume] : flows) {
    const Soil* base = soils[pair.first];
    const Soil* filter = soils[pair.second];
    if (base == nullptr || filter == nullptr || volume <= small_flow * largest) continue;
    if (base->gradation.empty() || filter->gradation.empty()) continue;
    add_pair(rows, *base, *filter);
  }
  return rows;
}

}  // namespace suffuse
