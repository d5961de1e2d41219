// Values for parameters where no material stands behind them.
#pragma once

#include "ir/module.h"

namespace lacquer::graph {

/// What a parameter is when nobody says: glTF's default for the property that its name is made from
/// ("coat_ior" is coatIor: 1.5) or ends in ("normal_scale": 1), else 0; kept within the range. It follows
/// from name, type and range alone, so that materials which share a shader agree on it.
ir::Components neutralValue(const ir::Parameter& parameter);

}  // namespace lacquer::graph
