#pragma once

/// One field of a snapshot as numbers to colour.

#include <optional>
#include <string>
#include <vector>

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Where a field was found: "cell", "element_vertex", "node", "solid" or "liquid".
struct FieldPlace {
  std::string name;
  std::string where;
};

/// Looks for a field in the snapshot `index`, on `on` ("cell", "node", "solid", "liquid") or, when
/// that is empty, anywhere, elements first. "node" means the elements' own linear fields too.
/// Throws InputError, naming `command`, that lists the fields there are and where they live.
FieldPlace find_field(const ResultsReader& results, std::size_t index, const std::string& name,
                      const std::string& on, const std::string& command);

/// `on cell: "a" or "b"; on node: ...` of the places named, or of all when none is.
std::string fields_and_places(const ResultsReader& results, std::size_t index,
                              const std::vector<std::string>& only = {});

/// Values with vectors replaced by their magnitude: per element, per vertex of every element, per
/// node or per point.
struct ScalarField {
  std::vector<double> values;
  std::string unit;
  bool is_vector = false;
};
ScalarField read_scalar(const ResultsReader& results, std::size_t index, const FieldPlace& place);

/// "concentration c (-)", "magnitude of darcy_flux q (m/s)"
std::string field_label(const FieldPlace& place, const ScalarField& field);

/// A value of a field that counts kinds.
struct Category {
  double value;
  std::string name;
  Color color;
};

/// The kinds of `saturation_state` and `region`; empty for fields that measure.
std::vector<Category> categories(const ResultsReader& results, const FieldPlace& place);

}  // namespace suffuse
