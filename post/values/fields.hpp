#pragma once

/// A field of a snapshot as one number per place, with its label.

#include <optional>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// A field and the places that have its values: "cell", "element_vertex", "node", "solid" or
/// "liquid".
struct FieldPlace {
  std::string name;
  std::string where;
  bool change = false;  ///< subtract the field of the first snapshot
};

/// Finds a field of the snapshot `index` on `on`: "cell", "node" (elements' own linear fields
/// included), "solid" or "liquid"; empty: the first of these that has it. Throws InputError, naming
/// `command`, with all fields and their places.
FieldPlace find_field(const ResultsReader& results, std::size_t index, const std::string& name,
                      const std::string& on, const std::string& command);

/// `on cell: "a" or "b"; on node: ...`, for the places in `only`, for all places when it is empty.
std::string fields_and_places(const ResultsReader& results, std::size_t index,
                              const std::vector<std::string>& only = {});

/// The field, its change included. Throws FileError; InputError for a change on points that were
/// not there at the start, or that move and have no field `id`.
Field read_field(const ResultsReader& results, std::size_t index, const FieldPlace& place);

/// A field with one number per element, per vertex of every element, per node or per point; of a
/// vector field the magnitudes.
struct ScalarField {
  std::vector<double> values;
  std::string unit;
  bool is_vector = false;
};
/// Reads a field of the snapshot `index`. Throws FileError.
ScalarField read_scalar(const ResultsReader& results, std::size_t index, const FieldPlace& place);

/// Values at nodes of a field that has them in addition to those of elements, of which means are
/// off by up to an element at boundaries. Empty if it has none.
std::vector<double> own_node_values(const ResultsReader& results, std::size_t index,
                                    FieldPlace place);

/// "Fines left", "Change of porosity since the start"
std::string field_title(const FieldPlace& place);
/// "concentration c (-)", "magnitude of Darcy flux q (m/s)"
std::string field_label(const FieldPlace& place, const ScalarField& field);

/// The snapshot nearest to a time, s, or the last. Throws FileError where there is none yet.
std::size_t snapshot_at(const ResultsReader& results, const std::optional<double>& time);
/// "5 h 33 min": the time of a snapshot, told apart from those before and after it.
std::string snapshot_time_words(const ResultsReader& results, std::size_t index);
/// "WHAT, 5 h 33 min", with the time asked for where the snapshot has another.
std::string snapshot_title(const ResultsReader& results, std::size_t index,
                           const std::optional<double>& asked, const std::string& what);

}  // namespace suffuse
