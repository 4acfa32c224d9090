// Values of JSON as reports need them: keys stay in the order in which they came, and nothing is read back. A header
// that compiles quickly, for every verb includes it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace cli {

class Json {
  public:
    using Member = std::pair<std::string, Json>;

    Json(std::nullptr_t = nullptr) {}
    /// Exactly bool, which pointers would become too.
    template <class Flag>
    requires(std::is_same_v<Flag, bool>) Json(Flag value) : value_(value) {}
    template <class Whole>
    requires(std::is_integral_v<Whole> && !std::is_same_v<Whole, bool>) Json(Whole value)
        : value_(static_cast<std::int64_t>(value)) {}
    /// What is not finite is written as null.
    Json(double value) : value_(value) {}
    Json(const char* text) : value_(std::string(text)) {}
    Json(std::string text) : value_(std::move(text)) {}
    template <class Value>
    Json(const std::vector<Value>& values) : value_(Array(values.begin(), values.end())) {}
    template <class Value, std::size_t n>
    Json(const std::array<Value, n>& values) : value_(Array(values.begin(), values.end())) {}
    template <class Value, std::size_t n>
    requires(!std::is_same_v<Value, char>) Json(const Value (&values)[n]) : value_(Array(values, values + n)) {}
    /// An object: {{"name", name}, {"count", 3}}.
    Json(std::initializer_list<Member> members);
    ~Json();
    Json(const Json&);
    Json(Json&&) noexcept;
    Json& operator=(const Json&);
    Json& operator=(Json&&) noexcept;

    static Json array();
    static Json object();

    bool is_null() const { return std::holds_alternative<std::nullptr_t>(value_); }
    bool is_number() const;
    bool is_string() const { return std::holds_alternative<std::string>(value_); }
    /// Of type std::string, bool, int, std::size_t or double. \throw std::logic_error where it is of another kind
    template <class Value>
    Value get() const;

    /// The member of that name; one that is not there is null at first, and null becomes an object.
    Json& operator[](std::string_view name);
    /// \throw std::logic_error where there is none
    const Json& operator[](std::string_view name) const;
    /// The member of that name, or none.
    const Json* find(std::string_view name) const;
    const std::vector<Member>& items() const;
    /// All members of another object, over those of the same name.
    void update(const Json& other);

    void push_back(Json value);
    const Json& operator[](std::size_t index) const { return elements().at(index); }
    std::vector<Json>::const_iterator begin() const { return elements().begin(); }
    std::vector<Json>::const_iterator end() const { return elements().end(); }

    /// Text with two blanks a level. Bytes of a string that are no UTF-8 become U+FFFD.
    std::string dump() const;

  private:
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;

    const Array& elements() const;
    void write(std::string& out, std::size_t depth) const;

    std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, Array, Object> value_;
};

}  // namespace cli
