// What the standard library of emscripten 3.1.6 (libc++ 13) lacks of C++17 and C++20 and our sources use, included
// before every file of the WebAssembly build. Semantics as in the standard; without threads an atomic_ref is a
// reference.
#pragma once

#pragma clang diagnostic ignored "-Wunused-variable"  // without OpenMP nobody reads the number of threads

#include <atomic>
#include <bit>
#include <charconv>
#include <memory>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

template <class T>
class atomic_ref {
  public:
    explicit atomic_ref(T& target) : target_(target) {}
    T load(memory_order = memory_order_seq_cst) const { return target_; }
    void store(T value, memory_order = memory_order_seq_cst) const { target_ = value; }

  private:
    T& target_;
};

template <class Array>
unique_ptr<Array> make_unique_for_overwrite(size_t length) {
    return unique_ptr<Array>(new remove_extent_t<Array>[length]);
}

/// Shortest text that reads back as the value; of fixed and scientific notation the shorter, fixed where equal.
to_chars_result to_chars(char* first, char* last, double value);
to_chars_result to_chars(char* first, char* last, float value);
to_chars_result to_chars(char* first, char* last, double value, chars_format format);
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);
/// Decimal notations, correctly rounded.
from_chars_result from_chars(const char* first, const char* last, double& value);
from_chars_result from_chars(const char* first, const char* last, float& value);

}  // namespace std
