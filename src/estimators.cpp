#include "estimators.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "scale_ladder.h"

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
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list(first_rung_choice + most_rungs * families);
        list[0] = "none", list[1] = "quadric 9", list[2] = "quartic 24", list[3] = "corrected";
        constexpr const char* family_names[families] = {
            "quadric ", "half mean quadric ", "mean quadric ",       "half slope ", "slope ", "quartic free ",
            "sphere ",  "fine sphere ",       "extrapolated sphere "};
        for (int rung = 0; rung < most_rungs; ++rung)
            for (int family = 0; family < families; ++family)
                list[rung_choice(rung, static_cast<Family>(family))] =
                    family_names[family] + std::to_string(rung_neighbors(rung));
        return list;
    }();
    if (choice >= names.size() || names[choice].empty())
        throw std::invalid_argument("choice = " + std::to_string(choice) + " is never written");
    return names[choice].c_str();
}

void check_estimator(Estimator estimator, Input input, bool confidence) {
    const std::string shown = std::string("estimator = ") + estimator_name(estimator);
    if (estimator == Estimator::corrected && input == Input::cloud)
        throw std::invalid_argument(shown + " is for meshes; a cloud has no faces");
    const bool fits = estimator != Estimator::dirichlet && estimator != Estimator::corrected;
    if (confidence && !fits) throw std::invalid_argument(shown + " has no confidence: nothing is fitted");
}

void check_jet(int k, int degree) {
    if (degree < 2)
        throw std::invalid_argument("degree = " + std::to_string(degree) +
                                    " has no curvature; estimator = jet takes 2 to 4");
    if (k < 5)
        throw std::invalid_argument("k = " + std::to_string(k) +
                                    " is too small; estimator = jet takes at least 5 neighbours");
}

}  // namespace gaussmap
