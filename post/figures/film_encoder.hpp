#pragma once

/// MP4 films, by the program ffmpeg.

#include <string>
#include <vector>

namespace suffuse {

/// Encodes PNG pictures of one size as MP4 (H.264, yuv420p), `rate` of them per second. `pattern`
/// names the pictures for ffmpeg, as "FOLDER/field_%04d.png", numbered from zero; `folder` is for
/// its messages. Returns false where there is no ffmpeg. Throws FileError if ffmpeg fails; then no
/// film is left behind.
bool encode_mp4(const std::string& pattern, int rate, const std::string& folder,
                const std::string& path);

}  // namespace suffuse
