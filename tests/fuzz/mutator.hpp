#pragma once

/// Changes inputs line by line, so that most of what they stand for stays valid.

#include <cstdint>
#include <functional>
#include <string>

#include "vocabulary.hpp"

namespace suffuse::fuzz {

/// A random number below `count`.
using Draw = std::function<std::size_t(std::size_t count)>;

/// One more edit of a script, on any subject.
std::string drawn_edit(const Vocabulary& words, const Draw& draw);

/// One more line of a scene.
std::string drawn_scene_line(const Vocabulary& words, const Draw& draw);

/// One more line of a geometry, which may be within a comment, a condition or a macro.
std::string drawn_geometry_line(const Vocabulary& words, const Draw& draw);

/// `input` with a few lines added, removed, repeated, swapped or changed.
/// \param new_line returns a new line
std::string changed(const std::string& input, const Draw& draw,
                    const std::function<std::string()>& new_line);

/// Some lines of `a`, then some lines of `b`.
std::string crossed(const std::string& a, const std::string& b, const Draw& draw);

}  // namespace suffuse::fuzz
