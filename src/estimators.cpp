#include "estimators.h"

#include <stdexcept>
#include <string>

namespace gaussmap {

const char* estimator_name(Estimator estimator) {
    switch (estimator) {
        case Estimator::automatic:
            return "auto";
        case Estimator::dirichlet:
            return "dirichlet";
        case Estimator::corrected:
            return "corrected";
        case Estimator::regression:
            return "regression";
        case Estimator::jet:
            return "jet";
    }
    throw std::invalid_argument("estimator = " + std::to_string(static_cast<int>(estimator)) + " is none of the five");
}

const char* choice_name(std::uint8_t choice) {
    constexpr const char* names[] = {"none", "dirichlet", "corrected", "regression", "jet 2", "jet 3", "jet 4"};
    if (choice >= std::size(names))
        throw std::invalid_argument("choice = " + std::to_string(choice) + " is outside [0, " +
                                    std::to_string(std::size(names)) + ")");
    return names[choice];
}

void check_estimator(Estimator estimator, Input input, bool confidence) {
    const std::string shown = std::string("estimator = ") + estimator_name(estimator);
    if (estimator == Estimator::corrected && input == Input::cloud)
        throw std::invalid_argument(shown + " is for meshes; a cloud has no faces");
    const bool fits = estimator != Estimator::dirichlet && estimator != Estimator::corrected;
    if (fits) throw std::invalid_argument(shown + " is not there yet; use dirichlet");
    if (confidence) throw std::invalid_argument(shown + " has no confidence: nothing is fitted");
}

}  // namespace gaussmap
