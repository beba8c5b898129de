#include "case/case_file.hpp"
#include "edited_files.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

/// A case that the reader accepts can be written again without change.
template <int Dim>
void check_round_trip(const Case<Dim>& c, const std::string& path) {
  const std::string again = path + ".again.h5";
  write_case(again, c);
  const Case<Dim> read = read_case<Dim>(again);
  require(read.mesh.nodes == c.mesh.nodes && read.mesh.elements == c.mesh.elements &&
              read.mesh.element_region == c.mesh.element_region &&
              read.mesh.region_names == c.mesh.region_names &&
              read.mesh.boundaries.size() == c.mesh.boundaries.size(),
          "a mesh changes when it is written and read");
  require(read.solid_points.barycentric == c.solid_points.barycentric &&
              read.liquid_points.barycentric == c.liquid_points.barycentric,
          "points change when they are written and read");
}

template <int Dim>
bool is_case(const std::string& path) {
  return is_taken(path, [&] { check_round_trip(read_case<Dim>(path), path); });
}

}  // namespace

void try_case(const std::string& input) {
  const std::string path = lay_out_case(input);
  int dimension = 0;
  static_cast<void>(is_taken(path, [&] { dimension = read_case_dimension(path); }));
  for (const auto& [of, taken] : {std::pair(2, is_case<2>(path)), {3, is_case<3>(path)}}) {
    require(!taken || dimension == of, "a case is read in a dimension that it does not have");
  }
  forget_files();
}

}  // namespace suffuse::fuzz
