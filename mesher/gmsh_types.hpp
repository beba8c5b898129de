#pragma once

/// Gmsh's numbers of the element types that are read and written (its manual, "MSH file format").

namespace suffuse::gmsh_type {

inline constexpr int none = 0;
inline constexpr int line = 1;
inline constexpr int triangle = 2;
inline constexpr int quadrangle = 3;
inline constexpr int tetrahedron = 4;

}  // namespace suffuse::gmsh_type
