#pragma once

/// Films of a field: a picture of every snapshot, in the same colours.

#include <string>

#include "figures/render.hpp"

namespace suffuse {

struct FilmRequest {
  RenderRequest picture;  ///< what to draw; its time and file are not used
  int rate = 10;          ///< pictures per second
  /// NAME.mp4: MP4 by ffmpeg, or NAME.png where there is no ffmpeg; NAME.png: animated PNG;
  /// FOLDER/: a picture per snapshot.
  std::string output;
};

/// Throws InputError for another output.
void check_film_output(const std::string& output);

/// Writes the whole film or nothing, and returns its path, which has another suffix than the
/// request where there is no ffmpeg. Throws as `render` does.
std::string write_film(const ResultsReader& results, const FilmRequest& request);

}  // namespace suffuse
