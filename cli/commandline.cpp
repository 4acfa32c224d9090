#include "commandline.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <thread>

#include "console.h"

namespace cli {
namespace {

constexpr std::size_t page_width = 80;
constexpr std::size_t option_width = 28;  // where the words about an option begin

template <class Number>
bool is_number(const std::string& text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// Columns of UTF-8 text: continuation bytes take none.
std::size_t columns(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

Check real_number(bool zero_too, const char* wanted) {
    return [=](const std::string& text) -> std::string {
        double value = 0;
        const bool good = is_number(text, value) && std::isfinite(value) && (value > 0 || (zero_too && value == 0));
        return good ? "" : fmt::format("'{}' is not {}", text, wanted);
    };
}

/// "-k" is how a one-letter name is typed, "--json" a longer one.
std::string names_of(const CLI::Option& option) {
    std::string text;
    for (const std::string& name : option.get_snames()) text += (text.empty() ? "-" : ", -") + name;
    for (const std::string& name : option.get_lnames()) text += (text.empty() ? "    --" : ", --") + name;
    return text;
}

/// What CLI11 found wrong, in our words: "--k: 'x' is not …".
std::string in_our_words(const CLI::ParseError& error) {
    std::string text = error.what();
    const std::size_t colon = text.find(": ");
    const std::string name = text.substr(0, colon);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return name + ": a value is missing; write one after it";
    return text;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent) {
    std::string out, word;
    std::size_t column = indent;
    const auto flush = [&] {
        if (word.empty()) return;
        const bool first = column == indent;
        if (!first && column + 1 + columns(word) > page_width) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (!first) {
            out += ' ';
            ++column;
        }
        out += word;
        column += columns(word);
        word.clear();
    };
    for (const char c : text) {
        if (c != ' ' && c != '\n') {
            word += c;
            continue;
        }
        flush();
        if (c == '\n') out += "\n" + std::string(indent, ' '), column = indent;
    }
    flush();
    return out;
}

Check one_of(const std::vector<std::string>& words) {
    return [words](const std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return "";
        return fmt::format("'{}' is not one of {}{}", text, fmt::join(words, ", "), did_you_mean(text, words));
    };
}

Check whole_number(std::int64_t least, std::int64_t most) {
    return [=](const std::string& text) -> std::string {
        std::int64_t value = 0;
        if (is_number(text, value) && value >= least && value <= most) return "";
        return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
    };
}

Check positive_number() {
    return real_number(false, "a number above 0");
}
Check number_of_at_least_zero() {
    return real_number(true, "a number of at least 0");
}

CommandLine::CommandLine(std::string usage, std::string about, std::string examples)
    : app_(std::make_unique<CLI::App>()),
      usage_(std::move(usage)),
      about_(std::move(about)),
      examples_(std::move(examples)) {
    app_->set_help_flag();  // the page is ours
    app_->allow_extras();   // told apart in refuse_unknown, with a "did you mean"
}

CommandLine::~CommandLine() = default;

void CommandLine::input(std::string& value, const std::string& name, const std::string& about) {
    app_->add_option(name, value)->group("");
    inputs_.push_back({name, about, &value, true});
}

void CommandLine::optional_input(std::string& value, const std::string& name, const std::string& about) {
    input(value, name, about);
    inputs_.back().required = false;
}

template <class Value>
void CommandLine::option(const std::string& names, Value& value, const std::string& value_name,
                         const std::string& about, const Check& check) {
    CLI::Option* const option = app_->add_option(names, value, about)
                                    ->type_name(value_name)
                                    ->group(group_)
                                    ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    if (check) option->check(check);
}
template void CommandLine::option(const std::string&, std::string&, const std::string&, const std::string&,
                                  const Check&);
template void CommandLine::option(const std::string&, int&, const std::string&, const std::string&, const Check&);
template void CommandLine::option(const std::string&, unsigned long&, const std::string&, const std::string&,
                                  const Check&);
template void CommandLine::option(const std::string&, unsigned long long&, const std::string&, const std::string&,
                                  const Check&);
template void CommandLine::option(const std::string&, double&, const std::string&, const std::string&, const Check&);

bool CommandLine::given(const std::string& name) const {
    return app_->count(name) > 0;
}

void CommandLine::flag(const std::string& names, bool& value, const std::string& about) {
    app_->add_flag(names, value, about)->group(group_);
}

void CommandLine::outputs(std::vector<std::string>& values, bool required, const std::string& extensions) {
    app_->add_option("-o,--output", values,
                     "Write this file; the extension decides the format (" + extensions +
                         "). As often as wanted; - is standard output")
        ->type_name("OUT")
        ->group(group_)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (required) required_outputs_ = &values;
}

void CommandLine::everywhere() {
    group("Everywhere");
    flag("--json", common.json, "One JSON object on standard output, nothing else there");
    option("--threads", common.threads, "N", "Threads to use (default: all there are). Results do not depend on it",
           whole_number(1, 1024));
    flag("-q,--quiet", common.quiet, "Nothing on standard error but errors");
    if (!app_->get_option_no_throw("--seed"))
        option("--seed", common.seed, "N", "Accepted for scripts; nothing here is random", whole_number(0, INT64_MAX));
}

bool CommandLine::parse(int argc, char** argv) {
    everywhere();
    bool help_asked = false, version_asked = false;
    flag("-h,--help", help_asked, "This page");
    flag("--version", version_asked, "Which gaussmap this is");
    try {
        app_->parse(argc - 1, argv + 1);
    } catch (const CLI::ParseError& error) {
        refuse_unknown();
        throw Failure(Exit::wrong_usage, in_our_words(error));
    }
    if (help_asked || version_asked) {
        put(help_asked ? help() : "gaussmap " GAUSSMAP_VERSION "\n");
        return false;
    }
    refuse_unknown();
    const std::string verb = argv[1];
    for (const Input& input : inputs_)
        if (input.required && input.value->empty())
            throw Failure(Exit::wrong_usage,
                          fmt::format("{}: {} is missing; write: gaussmap {}", verb, input.name, usage_));
    if (required_outputs_ && required_outputs_->empty())
        throw Failure(Exit::wrong_usage, fmt::format("{}: -o OUT is missing; write: gaussmap {}", verb, usage_));
    if (common.threads == 0) common.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return true;
}

void CommandLine::refuse_unknown() const {
    const std::vector<std::string> extras = app_->remaining();
    for (const std::string& extra : extras) {
        if (extra.size() < 2 || extra[0] != '-') continue;
        std::vector<std::string> known;
        for (const CLI::Option* option : app_->get_options())
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        const std::string name = extra.substr(0, extra.find('='));
        throw Failure(Exit::wrong_usage, fmt::format("unknown option '{}'{}", name, did_you_mean(name, known)));
    }
    if (!extras.empty())
        throw Failure(Exit::wrong_usage,
                      fmt::format("unexpected argument '{}'; write: gaussmap {}", extras.front(), usage_));
}

std::string CommandLine::help() const {
    std::string page = "Examples:\n";
    for (std::size_t begin = 0; begin < examples_.size();) {
        const std::size_t end = std::min(examples_.find('\n', begin), examples_.size());
        page += "  " + examples_.substr(begin, end - begin) + "\n";
        begin = end + 1;
    }
    page += fmt::format("\nUsage: gaussmap {}\n\n{}\n", usage_, wrapped(about_, 0));
    for (const Input& input : inputs_)
        page += fmt::format("{}  {:<{}}{}\n", &input == &inputs_.front() ? "\n" : "", input.name, option_width - 2,
                            wrapped(input.about, option_width));
    std::vector<std::string> groups;
    for (const CLI::Option* option : app_->get_options())
        if (!option->get_group().empty() &&
            std::find(groups.begin(), groups.end(), option->get_group()) == groups.end())
            groups.push_back(option->get_group());
    for (const std::string& title : groups) {
        page += fmt::format("\n{}:\n", title);
        for (const CLI::Option* option : app_->get_options()) {
            if (option->get_group() != title) continue;
            std::string left = "  " + names_of(*option);
            if (option->get_items_expected_max() > 0) left += " " + option->get_type_name();
            const bool fits = left.size() + 2 <= option_width;
            page +=
                left + (fits ? std::string(option_width - left.size(), ' ') : "\n" + std::string(option_width, ' '));
            page += wrapped(option->get_description(), option_width) + "\n";
        }
    }
    return page;
}

}  // namespace cli
