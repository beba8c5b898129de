#pragma once

/// Writes the values of an HDF5 dataset compressed, in the form of HDF5's own filters "shuffle" and
/// "deflate", which every reader of HDF5 undoes. The filters themselves take three times as long:
/// they also try to compress incompressible bytes, the low digits of computed numbers.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>

namespace suffuse {

/// Shape of a dataset of numbers and of the chunks, each of which is compressed by itself.
struct ChunkShape {
  std::size_t rows = 0;
  std::size_t columns = 1;      ///< each compressed by itself, so that zeros take few bytes
  std::size_t chunk_rows = 0;   ///< rows in each chunk, of one column
  std::size_t number_size = 8;  ///< bytes
};

/// The shape of `rows` times `columns` numbers, with chunks of at most 2^19 numbers.
ChunkShape chunk_shape(std::size_t rows, std::size_t columns, std::size_t number_size);

/// Fills the dataset `set`, which was created with such chunks and both filters, with `numbers`,
/// row by row. Returns false if HDF5 or zlib fails.
bool write_chunks(hid_t set, const ChunkShape& shape, const std::uint8_t* numbers);

}  // namespace suffuse
