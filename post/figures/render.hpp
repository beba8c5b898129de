#pragma once

/// Pictures of one field on the model: coloured elements or points, with axes and a colour bar,
/// and lines and arrows over them.

#include <optional>
#include <string>
#include <vector>

#include "figures/field_picture.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// What to draw. A field that exists in several places is drawn at the first of elements, nodes,
/// solid points and liquid points.
struct RenderRequest {
  std::string field;
  std::string on;                        ///< "cell", "node", "solid", "liquid" or empty
  std::optional<double> time;            ///< s; the nearest snapshot is drawn; unset: the last
  bool all = false;                      ///< every snapshot, all with the same colours
  std::vector<std::size_t> snapshots{};  ///< only these, in the same colours; empty: as above
  bool change = false;                   ///< the change since the start, not the field itself
  bool mesh = true;                      ///< edges of elements, where these are large
  std::optional<std::array<double, 2>> range;  ///< range of the colours; unset: that of the values
  bool logarithmic = false;                    ///< logarithmic scale of the colours
  bool contours = false;                       ///< lines of equal values
  bool vectors = false;                        ///< arrows of the flux
  /// A plane model gets ten, with equal discharges between neighbours. A model in space gets sixty,
  /// each with an equal discharge, in the colours of the field.
  bool streamlines = false;
  std::optional<ViewBox> view;  ///< unset: all of the model
  /// What is shown of a model in space: the plane `cut`, or the surfaces on which the field has
  /// these `levels`; without either, its outer surface.
  std::optional<CutPlane> cut{};
  std::vector<double> levels{};
  std::optional<Camera> camera{};  ///< of a model in space without a cut
  std::string output;  ///< NAME.png, .svg or .pdf; for several pictures NAME_0000.png and so on
};

/// Reads `LO:HI`, or `LO,HI`, with LO < HI. Throws InputError.
std::array<double, 2> parse_range(const std::string& text);
/// Reads `X0,Y0:X1,Y1` with X0 < X1 and Y0 < Y1. Throws InputError.
ViewBox parse_view(const std::string& text);
/// Reads `AZIMUTH,ELEVATION`. Throws InputError.
Camera parse_camera(const std::string& text);
/// Reads `V,V,...`. Throws InputError.
std::vector<double> parse_levels(const std::string& text);

/// Draws one colour per element, nodal and element-vertex fields in smooth colours, points as discs
/// over the mesh. Vectors are drawn by their magnitude. Fields whose values stand for kinds
/// (saturation_state, region) get a legend of names, others a colour bar. Returns the paths
/// written. Throws InputError, which lists the fields and where they are; FileError.
std::vector<std::string> render(const ResultsReader& results, const RenderRequest& request);

}  // namespace suffuse
