#include "ring_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "collapse_lanes.h"

namespace gaussmap {
namespace {

/// Whether a triangle of sides e, f from one corner, which become e2, f2, turns over or becomes a sliver.
inline bool spoils(Vec3 e, Vec3 f, Vec3 e2, Vec3 f2) {
    const Vec3 n = cross(e, f), n2 = cross(e2, f2);
    const double nn = squared(n), nn2 = squared(n2), cosine = dot(n, n2);
    const double l2 = squared(e2) + squared(f2) + squared(f2 - e2);
    const bool becomes_sliver = nn2 <= sliver * sliver * l2 * l2;
    const bool turns = cosine <= 0 || cosine * cosine < least_cosine * least_cosine * nn * nn2;
    if (!becomes_sliver && !turns) return false;
    const double l = squared(e) + squared(f) + squared(f - e);
    const bool was_sliver = nn <= sliver * sliver * l * l;
    // A sliver may become a better one.
    if (becomes_sliver && !(was_sliver && nn2 > 0 && nn2 * l * l > nn * l2 * l2)) return true;
    // The normal of what has no area says nothing.
    return turns && nn > 1e-20 * l * l;
}

}  // namespace

bool turns_over(Vec3 a, Vec3 b, Vec3 c, Vec3 a2, Vec3 b2, Vec3 c2) {
    return spoils(b - a, c - a, b2 - a2, c2 - a2);
}

RingMesh::RingMesh(std::vector<Vec3> positions, std::vector<std::int32_t> corners)
    : position(std::move(positions)),
      vertex(std::move(corners)),
      first(position.size(), -1),
      kind(position.size(), VertexKind::free),
      origin(vertex.size() / 3),
      tags(vertex.size() / 3, 0),
      next_(vertex.size()),
      mark_(position.size(), 0),
      faces_(vertex.size() / 3) {
    std::iota(origin.begin(), origin.end(), 0);
    link_all();
}

void RingMesh::link_all() {
    // From the last, so that rings run through the faces in their order.
    for (std::size_t c = vertex.size(); c-- > 0;) link(static_cast<std::int32_t>(c), vertex[c]);
}

std::uint32_t RingMesh::new_marks(std::uint32_t count) {
    if (marks_ > 0xffffffffu - 2 * count) {
        std::fill(mark_.begin(), mark_.end(), 0u);
        marks_ = 0;
    }
    const std::uint32_t mark = marks_ + 1;
    marks_ += count;
    return mark;
}

void RingMesh::link(std::int32_t corner, std::int32_t v) {
    if (first[v] < 0) {
        first[v] = next_[corner] = corner;
        return;
    }
    next_[corner] = next_[first[v]];
    next_[first[v]] = corner;
}

void RingMesh::unlink(std::int32_t corner) {
    const std::int32_t v = vertex[corner];
    if (next_[corner] == corner) {
        first[v] = -1;
        return;
    }
    std::int32_t previous = next_[corner];
    while (next_[previous] != corner) previous = next_[previous];
    next_[previous] = next_[corner];
    if (first[v] == corner) first[v] = previous;
}

void RingMesh::gather(std::int32_t v, Sectors& sectors) const {
    sectors.clear();
    for_corners(v, [&](std::int32_t c) { sectors.add({c, vertex[after(c)], vertex[before(c)]}); });
}

void RingMesh::look(std::int32_t a, std::int32_t b, Edge& edge) const {
    edge.a = a, edge.b = b;
    edge.of_a.clear(), edge.of_b.clear(), edge.shared.clear();
    for_corners(a, [&](std::int32_t c) {
        const Sector s{c, vertex[after(c)], vertex[before(c)]};
        const bool both = (s.from == b) | (s.to == b);
        edge.of_a.add(s, !both), edge.shared.add(s, both);
    });
    for_corners(b, [&](std::int32_t c) {
        const Sector s{c, vertex[after(c)], vertex[before(c)]};
        edge.of_b.add(s, (s.from != a) & (s.to != a));
    });
}

RingMesh::SharedFace RingMesh::shared_face(const Edge& edge, const Sector& s) {
    const std::int32_t n = after(s.corner), q = before(s.corner);
    return s.from == edge.b ? SharedFace{n, q} : SharedFace{q, n};
}

bool RingMesh::closed_fan(std::int32_t v, std::vector<std::int32_t>& follower) {
    // From neighbour to neighbour: each comes after v in one face, and the way leads through all of them.
    const std::uint32_t mark = new_marks(1);
    std::size_t degree = 0;
    bool regular = true;
    for_corners(v, [&](std::int32_t c) {
        const std::int32_t w = vertex[after(c)];
        regular &= mark_[w] != mark;
        mark_[w] = mark, follower[w] = vertex[before(c)], ++degree;
    });
    if (degree == 0 || !regular) return regular;
    const std::int32_t start = vertex[after(first[v])];
    std::int32_t at = start;
    do {
        if (mark_[at] != mark) return false;
        at = follower[at], --degree;
    } while (at != start && degree > 0);
    return at == start && degree == 0;
}

void RingMesh::tag_irregular_sides() {
    std::vector<std::int32_t> follower(first.size());
    for (std::size_t v = 0; v < first.size(); ++v) {
        const bool plain = closed_fan(static_cast<std::int32_t>(v), follower);
        kind[v] = plain ? VertexKind::free : VertexKind::corner;
        if (plain) continue;
        gather(static_cast<std::int32_t>(v), sectors_);
        for (const Sector& here : sectors_) {
            for (const std::int32_t w : {here.from, here.to}) {
                // The side from v to w belongs to faces (v, w, ·), where it runs out, and (·, w, v), where it runs in.
                int out = 0, in = 0;
                for (const Sector& other : sectors_) out += other.from == w, in += other.to == w;
                if (out == 1 && in == 1) continue;
                tag(w == here.from ? before(here.corner) : after(here.corner));
            }
        }
    }
}

void RingMesh::tag_features(double cosine) {
    for (std::size_t c = 0; c < vertex.size(); ++c) {
        const auto corner = static_cast<std::int32_t>(c);
        const std::int32_t other = twin(corner);
        if (other < corner) continue;
        const auto normal = [&](std::int32_t k) {
            const Vec3 p = position[vertex[k]];
            return cross(position[vertex[after(k)]] - p, position[vertex[before(k)]] - p);
        };
        const Vec3 n = normal(corner), m = normal(other);
        if (dot(n, m) < cosine * length(n) * length(m)) tag(corner), tag(other);
    }
}

bool RingMesh::all_in_one_fan() const {
    // Every side is regular: each sector has one before it and one after it.
    std::size_t walked = 0;
    const std::int32_t start = sectors_.begin()->from;
    std::int32_t at = start;
    do {
        const auto sector =
            std::find_if(sectors_.begin(), sectors_.end(), [&](const Sector& s) { return s.from == at; });
        at = sector->to;
        ++walked;
    } while (at != start);
    return walked == sectors_.size();
}

std::size_t RingMesh::parts() const {
    std::vector<std::size_t> part(sectors_.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
    const auto root = [&](std::size_t i) {
        while (part[i] != i) i = part[i];
        return i;
    };
    for (std::size_t i = 0; i < part.size(); ++i) {
        if (tagged(after(sectors_.begin()[i].corner))) continue;
        for (std::size_t j = 0; j < part.size(); ++j)
            if (sectors_.begin()[j].from == sectors_.begin()[i].to) part[root(j)] = root(i);
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < part.size(); ++i) count += part[i] == i;
    return count;
}

VertexKind RingMesh::kind_of(std::int32_t v) {
    gather(v, sectors_);
    std::size_t tagged_sides = 0, ends = 0;
    const std::uint32_t mark = new_marks(1);
    for (const Sector& s : sectors_)
        for (const auto& [opposite, end] : {std::pair{before(s.corner), s.from}, std::pair{after(s.corner), s.to}}) {
            if (!tagged(opposite)) continue;
            ++ends;
            if (mark_[end] != mark) mark_[end] = mark, ++tagged_sides;
        }
    if (tagged_sides == 0) return sectors_.size() == 0 || all_in_one_fan() ? VertexKind::free : VertexKind::corner;
    // Each part between tagged sides has two ends; a part more is a fan that touches the others in v alone.
    return tagged_sides == 2 && 2 * parts() == ends ? VertexKind::curve : VertexKind::corner;
}

void RingMesh::find_kinds() {
    for (std::size_t c = 0; c < vertex.size(); ++c)
        if (tags[c / 3] != 0) kind[vertex[c]] = VertexKind::corner;
    for (std::size_t v = 0; v < first.size(); ++v)
        if (kind[v] != VertexKind::free) kind[v] = kind_of(static_cast<std::int32_t>(v));
}

std::vector<std::int32_t> RingMesh::close_gaps() {
    std::vector<std::int32_t> renamed(first.size(), -1);
    std::int32_t vertices = 0;
    for (std::size_t v = 0; v < first.size(); ++v) {
        if (first[v] < 0) continue;
        position[vertices] = position[v];
        kind[vertices] = kind[v];
        renamed[v] = vertices++;
    }
    std::size_t faces = 0;
    for (std::size_t f = 0; f < tags.size(); ++f) {
        if (vertex[3 * f] < 0) continue;
        for (std::size_t k = 0; k < 3; ++k) vertex[3 * faces + k] = renamed[vertex[3 * f + k]];
        tags[faces] = tags[f];
        origin[faces++] = origin[f];
    }
    position.resize(vertices), kind.resize(vertices), mark_.resize(vertices);
    vertex.resize(3 * faces), next_.resize(3 * faces), tags.resize(faces), origin.resize(faces);
    first.assign(vertices, -1);
    link_all();
    return renamed;
}

/// Both have closed fans of untagged sides: every neighbour is met once, and the side has two faces. Of the two third
/// vertices each is met from one of the ends alone.
Refusal RingMesh::free_refusal(const Edge& edge) {
    const std::uint32_t mark = new_marks(1);
    bool common = false;
    for (const Sector& s : edge.of_a) mark_[s.from] = mark;
    for (const Sector& s : edge.of_b) common |= mark_[s.from] == mark;
    const bool tetrahedron = edge.of_a.size() <= 1 && edge.of_b.size() <= 1;
    return common || tetrahedron ? Refusal::topology : Refusal::none;
}

Refusal RingMesh::refusal(const Edge& edge, bool allow_topology) {
    const VertexKind ka = kind[edge.a], kb = kind[edge.b];
    if (ka == VertexKind::corner && kb == VertexKind::corner) return Refusal::locked;
    if (ka == VertexKind::free && kb == VertexKind::free && !allow_topology) return free_refusal(edge);
    const std::uint32_t mark = new_marks(3);  // + 0: joined to a, + 1: to both, + 2: by a face on both
    for (const auto* sectors : {&edge.of_a, &edge.shared})
        for (const Sector& s : *sectors) mark_[s.from] = mark_[s.to] = mark;
    std::size_t common = 0, opposite = 0;
    bool along = false, last = false;
    const auto count_common = [&](std::int32_t w) {
        if (mark_[w] == mark) mark_[w] = mark + 1, ++common;
    };
    for (const Sector& s : edge.of_b) count_common(s.from), count_common(s.to);
    for (const Sector& s : edge.shared) count_common(s.from == edge.b ? s.to : s.from);
    for (const Sector& s : edge.shared) {
        const auto [of_b, third] = shared_face(edge, s);
        along |= tagged(third);
        // The third vertex keeps a face, and two borders never become one.
        last |= next(third) == third || (tagged(s.corner) && tagged(of_b));
        if (mark_[vertex[third]] == mark + 1) mark_[vertex[third]] = mark + 2, ++opposite;
    }
    if (ka != VertexKind::free && kb != VertexKind::free && !along) return Refusal::locked;
    if (last) return Refusal::topology;
    if (common != opposite) {
        if (!allow_topology) return Refusal::topology;
        // A hole or a slit may close: there, both sides to the common neighbour are borders.
        const auto once = [](const Sectors& sectors, std::int32_t w) {
            return std::count_if(sectors.begin(), sectors.end(),
                                 [&](const Sector& s) { return s.from == w || s.to == w; }) == 1;
        };
        for (const Sector& s : edge.of_b)
            for (const std::int32_t w : {s.from, s.to})
                if (mark_[w] == mark + 1 && !(once(edge.of_a, w) && once(edge.of_b, w))) return Refusal::topology;
    }
    // No face may fall upon another, as those of a tetrahedron would.
    const auto of_both = [&](std::int32_t w) { return mark_[w] > mark && mark_[w] <= mark + 2; };
    for (const Sector& s : edge.of_b) {
        if (!of_both(s.from) || !of_both(s.to)) continue;
        for (const Sector& t : edge.of_a)
            if ((t.from == s.from && t.to == s.to) || (t.from == s.to && t.to == s.from)) return Refusal::topology;
    }
    return Refusal::none;
}

bool RingMesh::turns(std::int32_t v, const Sectors& sectors, Vec3 p) const {
    const Vec3 at = position[v];
    if (!collapse_lanes().may_spoil(position.data(), sectors.begin(), sectors.size(), at, p)) return false;
    return std::any_of(sectors.begin(), sectors.end(), [&](const Sector& s) {
        const Vec3 from = position[s.from], to = position[s.to];
        return spoils(from - at, to - at, from - p, to - p);
    });
}

bool RingMesh::folds(const Edge& edge, Vec3 p) const {
    return turns(edge.a, edge.of_a, p) || turns(edge.b, edge.of_b, p);
}

bool RingMesh::folds(std::int32_t v, Vec3 p) {
    gather(v, sectors_);
    return turns(v, sectors_, p);
}

void RingMesh::collapse(const Edge& edge, Vec3 p) {
    const std::int32_t a = edge.a, b = edge.b;
    const bool tags_matter = kind[a] != VertexKind::free || kind[b] != VertexKind::free;
    std::int32_t widened[8];  // third vertices of faces that go with a tagged side
    std::size_t widen = 0;
    std::int32_t head = -1, tail = -1;
    const auto keep = [&](std::int32_t corner) {
        vertex[corner] = a;
        (head < 0 ? head : next_[tail]) = corner;
        tail = corner;
    };
    for (const Sector& s : edge.of_a) keep(s.corner);
    for (const Sector& s : edge.of_b) keep(s.corner);
    for (const Sector& s : edge.shared) {
        const auto [of_b, third] = shared_face(edge, s);
        if (tags_matter && (tagged(s.corner) || tagged(of_b)) && widen < 8) widened[widen++] = vertex[third];
        unlink(third);
        vertex[s.corner] = vertex[of_b] = vertex[third] = -1;
        --faces_;
    }
    if (tail >= 0) next_[tail] = head;
    first[a] = head;
    first[b] = -1;
    position[a] = p;
    kind[a] = std::max(kind[a], kind[b]);
    for (std::size_t i = 0; i < widen; ++i)
        for_corners(a, [&](std::int32_t c) {
            if (vertex[after(c)] == widened[i]) tag(before(c));
            if (vertex[before(c)] == widened[i]) tag(after(c));
        });
}

std::int32_t RingMesh::twin(std::int32_t corner) const {
    const std::int32_t from = vertex[after(corner)], to = vertex[before(corner)];
    std::int32_t found = -1;
    int faces = 0;
    for_corners(from, [&](std::int32_t c) {
        const std::int32_t n = after(c), q = before(c);
        faces += vertex[n] == to || vertex[q] == to;
        if (vertex[q] == to) found = n;
    });
    return faces == 2 ? found : -1;
}

void RingMesh::flip(std::int32_t corner, std::int32_t other) {
    // Faces (a, b, c) with a at the corner and (d, c, b) with d at its twin become (a, b, d) and (d, c, a).
    const std::int32_t a = vertex[corner], d = vertex[other];
    const std::int32_t at_c = before(corner), at_b = before(other);
    const std::int32_t fa = corner / 3, fd = other / 3;
    const auto bit = [](std::int32_t c) { return static_cast<std::uint8_t>(1 << c % 3); };
    const bool side_ca = tagged(after(corner)), side_bd = tagged(after(other));
    unlink(at_c);
    unlink(at_b);
    vertex[at_c] = d;
    vertex[at_b] = a;
    link(at_c, d);
    link(at_b, a);
    // The sides that changed faces take their tags along: side b–d lies opposite a's corner, c–a opposite d's.
    tags[fa] = static_cast<std::uint8_t>((tags[fa] & bit(at_c)) | (side_bd ? bit(corner) : 0));
    tags[fd] = static_cast<std::uint8_t>((tags[fd] & bit(at_b)) | (side_ca ? bit(other) : 0));
}

}  // namespace gaussmap
