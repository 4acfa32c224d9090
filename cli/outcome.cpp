#include "outcome.h"

#include <exception>
#include <new>

#include "gaussmap/io.h"

namespace cli {

Exit outcome_of(void (*work)(int argc, char** argv), int argc, char** argv) {
    try {
        work(argc, argv);
        return Exit::done;
    } catch (const Failure& failure) {
        complain(failure.what());
        return failure.code;
    } catch (const gaussmap::FormatError& error) {
        complain(error.what());
        return Exit::bad_input;
    } catch (const std::bad_alloc&) {
        complain("out of memory; close other programs, or work on a smaller file");
    } catch (const std::exception& error) { complain(error.what()); }
    return Exit::failed;
}

}  // namespace cli
