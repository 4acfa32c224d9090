// From the type named in a file to the type of C++, unaligned values of either byte order, and rows of properties.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

#include "gaussmap/io.h"

namespace gaussmap::io {

/// Call f with a zero of the C++ type that `type` names.
template <class F>
decltype(auto) with_type(Type type, F&& f) {
    switch (type) {
        case Type::int8:
            return f(std::int8_t{});
        case Type::uint8:
            return f(std::uint8_t{});
        case Type::int16:
            return f(std::int16_t{});
        case Type::uint16:
            return f(std::uint16_t{});
        case Type::int32:
            return f(std::int32_t{});
        case Type::uint32:
            return f(std::uint32_t{});
        case Type::int64:
            return f(std::int64_t{});
        case Type::uint64:
            return f(std::uint64_t{});
        case Type::float32:
            return f(float{});
        case Type::float64:
            break;
    }
    return f(double{});
}

inline bool is_float(Type type) {
    return type == Type::float32 || type == Type::float64;
}

/// The value at `from`, which need not be aligned.
template <class T>
T value_at(const void* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
void put(void* to, T value) {
    std::memcpy(to, &value, sizeof value);
}

/// The value with its bytes in reverse order.
template <class T>
T swapped(T value) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

/// Number of items that the property holds a value, or a list, of.
inline std::size_t item_count(const Property& property) {
    return property.list ? std::max<std::size_t>(1, property.offsets.size()) - 1 : property.values();
}

/// Values [first, last) of item i.
struct ValueRange {
    std::size_t first = 0, last = 0;
};
inline ValueRange values_of(const Property& property, std::size_t i) {
    if (!property.list) return {i, i + 1};
    return {static_cast<std::size_t>(property.offsets[i]), static_cast<std::size_t>(property.offsets[i + 1])};
}

/// The same property for the items named by `rows`, in that order.
Property select_rows(const Property& property, std::span<const std::uint64_t> rows);

/// \throw std::invalid_argument  an array of the wrong length, an index out of range: the first found, by name.
void check(const Geometry& geometry);

}  // namespace gaussmap::io
