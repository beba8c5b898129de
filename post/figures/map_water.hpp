#pragma once

/// The water that a map of the model shows: what stands outside, and the phreatic line; walls and
/// wells.

#include <vtkContext2D.h>

#include <vector>

#include "drawing/contours.hpp"
#include "drawing/model_view.hpp"
#include "results/reader.hpp"
#include "values/outside_water.hpp"

namespace suffuse {

inline constexpr Color black{0.0, 0.0, 0.0};
inline constexpr Color white{1.0, 1.0, 1.0};

/// The water outside at the time of the snapshot `index`, as wide as it is drawn. `axes`: axes of
/// the model along the coordinates of the mesh.
std::vector<OutsideWater> water_outside(const ResultsReader& results, std::size_t index,
                                        const Mesh<2>& mesh,
                                        const std::array<int, 2>& axes = {0, 1});

/// A view of the model and the water outside. `bottom`: room beneath, pixels.
ModelView view_with_water(const Mesh<2>& mesh, const std::vector<OutsideWater>& waters,
                          float bottom);

/// Paints the water, its level with the triangle of a water level, and the head next to it.
void paint_outside_water(vtkContext2D& painter, const ModelView& view,
                         const std::vector<OutsideWater>& waters);

/// The lines p = 0 of pressures at nodes.
std::vector<Polyline> phreatic_lines(const Mesh<2>& mesh, const std::vector<double>& pressure);
void paint_phreatic_lines(vtkContext2D& painter, const ModelView& view,
                          const std::vector<Polyline>& lines);

/// Walls and wells within a model.
struct Structures {
  Edges walls;
  Edges wells;
};
Structures structures(const Mesh<2>& mesh, const Scene& scene);
void paint_structures(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                      const Structures& structures);
/// Adds the lines for the walls and wells that there are.
void add_structure_legend(std::vector<Curve>& rows, const Structures& structures);

/// A line of a legend.
Curve legend_line(const std::string& label, const Color& color, float width);
/// Adds the lines for the water that the map shows.
void add_water_legend(std::vector<Curve>& rows, bool has_phreatic_line, bool has_outside_water);

}  // namespace suffuse
