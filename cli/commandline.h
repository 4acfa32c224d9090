// The command line of one verb: options in groups, a help page that opens with examples, and one-line errors.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace cli {

/// What every verb takes.
struct Common {
    bool json = false;
    bool quiet = false;
    int threads = 0;  ///< as many as are used: never 0 once parsed
    std::uint64_t seed = 0;
};

/// A check of an option's value as it was typed: the message of what is wrong, or nothing.
using Check = std::function<std::string(const std::string& text)>;
Check one_of(const std::vector<std::string>& words);
Check whole_number(std::int64_t least, std::int64_t most);
Check positive_number();
Check number_of_at_least_zero();

/// Wraps CLI11: the texts are ours, the parsing is its. Its headers stay in commandline.cpp: they take longer to
/// compile than a verb does.
class CommandLine {
  public:
    /// \param usage     "curvature IN [-o OUT]…"
    /// \param about     paragraphs, parted by empty lines
    /// \param examples  lines of a command, two blanks and what it does
    CommandLine(std::string usage, std::string about, std::string examples);
    ~CommandLine();

    /// A positional argument, required; the first one named is the first one typed.
    void input(std::string& value, const std::string& name, const std::string& about);
    /// One more that may be left out.
    void optional_input(std::string& value, const std::string& name, const std::string& about);
    /// Options of the group that `group` last began. `value_name` is what the help calls the value: "N". A value is
    /// text, an int, an unsigned whole number or a double.
    template <class Value>
    void option(const std::string& names, Value& value, const std::string& value_name, const std::string& about,
                const Check& check = {});
    void flag(const std::string& names, bool& value, const std::string& about);
    /// -o, as often as wanted, each with one value; `extensions` is what its help names.
    void outputs(std::vector<std::string>& values, bool required, const std::string& extensions);
    void group(const std::string& title) { group_ = title; }

    /// True when there is something to do; false when the help was asked for and has been printed.
    /// \throw Failure (wrong usage)
    bool parse(int argc, char** argv);

    /// Was the option given? By its long name, "--k".
    bool given(const std::string& name) const;

    Common common;

  private:
    void everywhere();
    void refuse_unknown() const;
    std::string help() const;

    std::unique_ptr<CLI::App> app_;
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
