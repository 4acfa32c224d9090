// How a run ends: its exit code, and one line where it is not done.
#pragma once

#include "console.h"

namespace cli {

/// Do the work and turn every way it can end into an exit code; what it throws becomes one line on standard error.
Exit outcome_of(void (*work)(int argc, char** argv), int argc, char** argv);

}  // namespace cli
