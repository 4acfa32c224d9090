// One verb, one file: each reads its own command line (argv[1] is the verb), does the work, and reports.
#pragma once

namespace cli {

void curvature(int argc, char** argv);
void normals(int argc, char** argv);
void compare(int argc, char** argv);
void decimate(int argc, char** argv);
void sample(int argc, char** argv);
void shape(int argc, char** argv);
void convert(int argc, char** argv);
void info(int argc, char** argv);
void view(int argc, char** argv);

}  // namespace cli
