// NumPy arrays in, as views; vectors out, as arrays that own them. Nothing is copied.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/types.h"

namespace binding {

namespace nb = nanobind;

/// Results by name.
using Record = nb::typed<nb::dict, nb::str, nb::any>;
/// Several results in a row.
using Tuple = nb::typed<nb::tuple, nb::any, nb::ellipsis>;
template <class T>
using Rows = nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using PointArray = Rows<double>;
using FaceArray = Rows<std::int32_t>;
using IndexTable = nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

inline gaussmap::Points points(const PointArray& array) {
    return {array.data(), array.shape(0)};
}
inline gaussmap::Points points(const std::optional<PointArray>& array) {
    return array ? points(*array) : gaussmap::Points();
}
inline gaussmap::Triangles triangles(const FaceArray& array) {
    return {array.data(), array.shape(0)};
}
inline gaussmap::Triangles triangles(const std::optional<FaceArray>& array) {
    return array ? triangles(*array) : gaussmap::Triangles();
}

/// The vector as an array of `columns` values a row (one-dimensional for 1), its memory handed over.
template <class T>
nb::any array(std::vector<T>&& values, std::size_t columns = 1) {
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* vector) noexcept { delete static_cast<std::vector<T>*>(vector); });
    if (kept->empty()) kept->reserve(1);  // an array of nothing still has an address
    const std::size_t shape[] = {kept->size() / columns, columns};
    const nb::ndarray<nb::numpy, T> made(kept->data(), columns == 1 ? 1 : 2, shape, owner);
    return nb::steal<nb::any>(nb::cast(made).release());
}

/// The same; None for what was not made.
template <class T>
nb::object array_or_none(std::vector<T>&& values, std::size_t columns = 1) {
    return values.empty() ? nb::object(nb::none()) : nb::object(array(std::move(values), columns));
}

/// The value that goes by the name. \throw std::invalid_argument with the names there are
template <class Value>
Value named(const char* argument, const std::string& name,
            std::initializer_list<std::pair<const char*, Value>> values) {
    std::string known;
    for (const auto& [word, value] : values) {
        if (name == word) return value;
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw std::invalid_argument(std::string(argument) + " = '" + name + "' is not one of " + known);
}

}  // namespace binding
