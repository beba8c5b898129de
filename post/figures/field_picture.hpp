#pragma once

/// The picture of one field on the model, and the lines and arrows over it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "drawing/model_view.hpp"
#include "drawing/space.hpp"
#include "figures/field_scale.hpp"
#include "figures/map_water.hpp"
#include "values/outside_water.hpp"
#include "values/sheet.hpp"

namespace suffuse {

/// Two corners of a part of the model, m.
using ViewBox = std::array<Vector<2>, 2>;

/// What all pictures of a run share: a plane model, or the surface of one in space, projected.
struct PictureModel {
  Mesh<2> mesh;
  Edges all_edges;
  Outlines outlines;
  Structures structures{};
  std::optional<ViewBox> box;        ///< unset: all of the model is shown
  std::vector<char> visible;         ///< per element: whether it reaches into the box
  std::ptrdiff_t visible_count = 0;  ///< number of visible elements
  std::array<std::string, 2> axes{"x (m)", "y (m)"};
  std::optional<SpaceBox> space{};  ///< unset: a plane model
  std::vector<double> depth{};      ///< per node of a model in space, towards the viewer, m

  /// Position of a node of a model in space.
  [[nodiscard]] Vector<3> projected(int node) const {
    return {mesh.nodes[node][0], mesh.nodes[node][1], depth[node]};
  }
};
/// `is_open`: per region of the mesh, whether it is without soil; empty: none is.
PictureModel picture_model(const Mesh<2>& mesh, const std::optional<ViewBox>& box,
                           std::vector<bool> is_open = {});
/// The outer edges of the result are those at which the surface bends.
PictureModel space_model(const Mesh<3>& mesh, const Sheet& surface, const Vector<3>& upward,
                         const Camera& camera = {});

/// A triangle within a model in space, projected, m, and its colour.
struct SpaceTriangle {
  std::array<Vector<3>, 3> corners;
  Color color;
};

/// A line within a model in space, projected, m, and its colour.
struct SpaceLine {
  std::array<Vector<3>, 2> ends;
  Color color;
};

/// The content of one picture.
struct FieldPicture {
  std::string title;
  std::string label;           ///< label of the colour bar, with the unit
  std::string where;           ///< "cell", "node", "element_vertex", "solid" or "liquid"
  std::vector<double> values;  ///< at elements, nodes, vertices of elements or points
  /// At nodes, for lines of equal values; empty: from `values`.
  std::vector<double> line_values = {};
  std::vector<Vector<2>> positions;  ///< places of points; empty for fields of elements and nodes
  std::vector<double> volumes;       ///< of points that move, m3 per metre of thickness; or empty
  std::vector<bool> air{};           ///< elements of which nothing is shown; or empty
  FieldScale scale;
  std::vector<OutsideWater> water;
  std::vector<OutsideWater> room;  ///< water of all pictures of the run, for a common view
  bool mesh_edges = true;          ///< draw the edges of elements, where these are large
  bool contours = false;           ///< draw lines of equal values at the round values of the bar
  std::vector<double> arrows;      ///< two components per element; empty: none
  std::string arrow_label = "flux q";
  std::string arrow_unit = "m/s";
  std::vector<double> streamfunction;  ///< at nodes, m2/s; empty: no streamlines
  double tube = 0.0;    ///< discharge between two streamlines, m2/s; in space of each one, m3/s
  double misfit = 0.0;  ///< misfit of the stream function
  bool hollow = false;  ///< draw the edges of a model in space, not its surface
  std::vector<SpaceTriangle> inside;  ///< triangles inside a hollow model
  std::vector<SpaceLine> paths;       ///< streamlines of a model in space

  [[nodiscard]] bool of_points() const { return where == "solid" || where == "liquid"; }
};

/// Values of a field of elements or nodes at the corners of an element.
std::array<double, 3> corner_values(const FieldPicture& picture, const Mesh<2>& mesh, int element);

/// Values at nodes of a field of elements or nodes: means over the elements around, by area.
std::vector<double> nodal_values(const Mesh<2>& mesh, const FieldPicture& picture);

/// Draws one colour per element, nodal and element-vertex fields in smooth colours, and
/// what each point fills in its colour. Throws InputError for an unknown suffix, FileError.
void draw_field_picture(const PictureModel& model, const FieldPicture& picture,
                        const std::string& path);

}  // namespace suffuse
