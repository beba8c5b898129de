#include "checks/erosion_checks.hpp"

#include <algorithm>
#include <limits>

#include "files/number_text.hpp"
#include "values/derived_fields.hpp"
#include "values/dry_mass.hpp"

namespace suffuse {
namespace {

/// The largest drive in the elements of a soil, in one snapshot.
template <int Dim>
class SoilDrive {
 public:
  SoilDrive(const ResultsReader& results, const Mesh<Dim>& mesh, const Soil& soil,
            std::size_t index)
      : mesh_(mesh),
        soil_(soil),
        model_(soil.exchange_model(results.scene().scene.liquid)),
        factor_(conductivity_factor(results, soil)),
        flux_(results.field(index, "cell", "darcy_flux").values),
        porosity_(results.field(index, "cell", "porosity").values),
        concentration_(results.field(index, "cell", "concentration").values) {
    if (model_.erosion.length > 0.0) {
      eroding_flux_ = results.field(index, "cell", "eroding_flux").values;
    }
  }

  [[nodiscard]] double at(int element) const {
    const Vector<Dim> q = Vector<Dim>::Map(&flux_[Dim * static_cast<std::size_t>(element)]);
    const double initial = soil_.initial_porosity(element_centroid(mesh_, element));
    const PlaceFlow flow{.resistance = soil_.resistance_along(q),
                         .concentration = concentration_[element]};
    const double flux = eroding_flux_.empty() ? q.norm() : eroding_flux_[element];
    return drive_at(model_, {initial, porosity_[element], factor_[element]}, flow, flux);
  }

 private:
  const Mesh<Dim>& mesh_;
  const Soil& soil_;
  ExchangeModel model_;
  std::vector<double> factor_;
  std::vector<double> flux_;
  std::vector<double> porosity_;
  std::vector<double> concentration_;
  std::vector<double> eroding_flux_;  ///< empty: erosion sees the flux of the place
};

bool is_in(const auto& mesh, int element, const Soil& soil) {
  return mesh.region_names[mesh.element_region[element]] == soil.region;
}

CheckRow without_threshold(const Soil& soil) {
  CheckRow row{.mechanism = "erosion", .where = soil.region, .clause = "erosion law of the scene"};
  row.note = soil.erosion_model().drive->depends_on_flow()
                 ? "the law has no threshold: any flow erodes"
                 : "the law erodes with time, whatever the flow";
  return row;
}

template <int Dim>
CheckRow threshold_check(const ResultsReader& results, const Mesh<Dim>& mesh, const Soil& soil) {
  const ErosionModel model = soil.erosion_model();
  CheckRow row = without_threshold(soil);
  row.note.clear();
  row.unit = std::string(model.drive->unit);
  row.resistance = model.threshold;
  row.effect = 0.0;
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    const SoilDrive<Dim> drive(results, mesh, soil, i);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!is_in(mesh, e, soil)) continue;
      const double found = drive.at(e);
      if (!(found > row.effect)) continue;
      row.note_factor(row.resistance / found, results.times()[i]);
      row.effect = found;
      row.time = results.times()[i];
      const Vector<Dim> x = element_centroid(mesh, e);
      row.place.assign(x.data(), x.data() + Dim);
    }
  }
  if (row.effect > 0.0) row.factor = row.resistance / row.effect;
  return row;
}

std::string erosion_class(double per_cent) {
  if (per_cent <= 0.2) return "no erosion";
  if (per_cent <= 1.0) return "some erosion";
  return per_cent <= 5.0 ? "excessive erosion" : "continuing erosion";
}

}  // namespace

std::vector<CheckRow> threshold_checks(const ResultsReader& results) {
  std::vector<CheckRow> rows;
  for (const Soil& soil : results.scene().scene.soils) {
    const ErosionModel model = soil.erosion_model();
    if (!erodes(model)) continue;
    const bool opens = model.drive->depends_on_flow() && model.threshold > 0.0;
    rows.push_back(
        opens ? with_mesh(results,
                          [&](const auto& mesh) { return threshold_check(results, mesh, soil); })
              : without_threshold(soil));
  }
  return rows;
}

std::vector<CheckRow> loss_checks(const ResultsReader& results) {
  const Scene& scene = results.scene().scene;
  const bool forgets = scene.moves() && !scene.initial_from.empty();
  std::vector<CheckRow> rows;
  for (const DryMass& mass : dry_masses(results)) {
    const double lost = 100.0 * (mass.initial - mass.last) / mass.initial;
    CheckRow row{.mechanism = "loss", .where = mass.region, .clause = "Douglas and others (2019)"};
    row.time = mass.time;
    row.effect = lost;
    row.unit = "%";
    row.note = lost < 0.0 ? "the soil has gained " + short_text(-lost) + " %"
                          : erosion_class(lost) + ": " + short_text(lost) + " %";
    row.note += " of its dry mass at the start";
    if (forgets) row.note += " of this stage";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace suffuse
