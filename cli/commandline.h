// The command line of one verb: options in groups, a help page that opens with examples, and one-line errors.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace cli {

/// What every verb takes.
struct Common {
    bool json = false;
    bool quiet = false;
    int threads = 0;  ///< as many as are used: never 0 once parsed
    std::uint64_t seed = 0;
};

/// Checks of option values; each gives the message of what is wrong, or nothing.
CLI::Validator one_of(const std::vector<std::string>& words);
CLI::Validator whole_number(std::int64_t least, std::int64_t most);
CLI::Validator positive_number();
CLI::Validator number_of_at_least_zero();

/// Wraps CLI11: the texts are ours, the parsing is its.
class CommandLine {
  public:
    /// \param usage     "curvature IN [-o OUT]…"
    /// \param about     paragraphs, parted by empty lines
    /// \param examples  lines of a command, two blanks and what it does
    CommandLine(std::string usage, std::string about, std::string examples);

    /// A positional argument, required; the first one named is the first one typed.
    void input(std::string& value, const std::string& name, const std::string& about);
    /// One more that may be left out.
    void optional_input(std::string& value, const std::string& name, const std::string& about);
    /// Options of the group that `group` last began. `value_name` is what the help calls the value: "N".
    template <class Value>
    CLI::Option* option(const std::string& names, Value& value, const std::string& value_name,
                        const std::string& about) {
        return app_.add_option(names, value, about)
            ->type_name(value_name)
            ->group(group_)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    }
    CLI::Option* flag(const std::string& names, bool& value, const std::string& about);
    /// -o, as often as wanted, each with one value; `extensions` is what its help names.
    void outputs(std::vector<std::string>& values, bool required, const std::string& extensions);
    void group(const std::string& title) { group_ = title; }

    /// True when there is something to do; false when the help was asked for and has been printed.
    /// \throw Failure (wrong usage)
    bool parse(int argc, char** argv);

    /// Was the option given? By its long name, "--k".
    bool given(const std::string& name) const { return app_.count(name) > 0; }

    Common common;

  private:
    void everywhere();
    void refuse_unknown() const;
    std::string help() const;

    CLI::App app_;
    std::string usage_, about_, examples_, group_ = "Options";
    struct Input {
        std::string name, about;
        const std::string* value;
        bool required;
    };
    std::vector<Input> inputs_;
    const std::vector<std::string>* required_outputs_ = nullptr;
};

/// Lines of at most 80 columns, each but the first after `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent);

}  // namespace cli
