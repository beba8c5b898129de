/// Erosion does not depend on the flow.

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {

extern const DriveLaw time{.word = "time", .equation = "1", .symbol = "1", .rate_unit = "1/s"};

}  // namespace suffuse::drive
