// The estimators by name, and which of them there are.
#pragma once

#include "gaussmap/curvature.h"

namespace gaussmap {

enum class Input { mesh, cloud };

/// \throw std::invalid_argument where the estimator is not for such an input, or has no confidence and one is asked
/// for.
void check_estimator(Estimator estimator, Input input, bool confidence);

/// Less than a quadric has no curvature.
/// \throw std::invalid_argument on a degree below 2 or too few neighbours for a quadric.
void check_jet(int k, int degree);

}  // namespace gaussmap
