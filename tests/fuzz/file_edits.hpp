#pragma once

/// Damage to files, as text: small, readable and easy to vary.
///
/// A script has one edit per line; lines that are no edit, or do not fit the files, are ignored.
/// NAME is an object of an HDF5 file, `/mesh/nodes`; numbers wrap round at the ends of what they
/// index.
///
///     seed NAME                  which valid files to start from, on the first line
///     in FILE                    the edits that follow are to this file
///     value NAME I X             value I of a dataset becomes X, a number or a text
///     type NAME TYPE             the dataset anew, of another type: i8 u8 i32 u32 i64 u64 f32 f64
///                                big text vtext compound array opaque enum reference bits
///     shape NAME E...            the dataset anew with other extents, its values repeated
///     claim NAME LAYOUT E...     the dataset anew with extents that nothing stands for: chunked,
///                                deflate, contiguous, external, virtual
///     text NAME TEXT             a dataset of one text
///     remove NAME | group NAME | type-object NAME
///     rename NAME NAME | copy NAME NAME | hard NAME NAME | soft NAME TARGET | outside NAME FILE
///     attribute NAME NAME TYPE X | no-attribute NAME NAME
///     set TEXT                   one more `--set` argument in the scene of the file
///     json POINTER JSON          of a JSON file
///     line N TEXT                of a text file
///     byte AT X | cut LENGTH | grow LENGTH      applied last, to the bytes of the file
///     delete | folder            no file, or a folder of its name

#include <string>
#include <vector>

namespace suffuse::fuzz {

/// The word after `seed` on the first line, or the first of `known`.
std::string seed_of(const std::string& script, const std::vector<std::string>& known);

/// Applies the edits of `script` to files of `folder`, beginning with `file`.
void apply_edits(const std::string& script, const std::string& folder, const std::string& file);

}  // namespace suffuse::fuzz
