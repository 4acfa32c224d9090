// PNG by libspng.
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "gaussmap/picture.h"

#ifdef GAUSSMAP_PNG
#include <spng.h>
#endif

namespace gaussmap {
namespace {

void check(const Picture& picture) {
    const bool sized = picture.width > 0 && picture.height > 0;
    const std::size_t expected = sized ? 3 * static_cast<std::size_t>(picture.width) * picture.height : 0;
    if (sized && picture.rgb.size() == expected) return;
    throw std::invalid_argument("png_bytes: a picture of " + std::to_string(picture.width) + " × " +
                                std::to_string(picture.height) + " pixels with " + std::to_string(picture.rgb.size()) +
                                " bytes of rgb; there must be 3 a pixel, and a pixel");
}

}  // namespace

#ifdef GAUSSMAP_PNG

namespace {

void must(int code) {
    if (code != 0) throw std::runtime_error(std::string("png_bytes: ") + spng_strerror(code));
}

}  // namespace

std::string png_bytes(const Picture& picture) {
    check(picture);
    const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
    if (!context) throw std::bad_alloc();
    must(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1));
    spng_ihdr header = {};
    header.width = static_cast<std::uint32_t>(picture.width);
    header.height = static_cast<std::uint32_t>(picture.height);
    header.bit_depth = 8;
    header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
    must(spng_set_ihdr(context.get(), &header));
    must(spng_set_srgb(context.get(), 0));  // perceptual
    must(spng_encode_image(context.get(), picture.rgb.data(), picture.rgb.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE));
    std::size_t size = 0;
    int error = 0;
    const std::unique_ptr<void, void (*)(void*)> bytes(spng_get_png_buffer(context.get(), &size, &error), std::free);
    must(error);
    return {static_cast<const char*>(bytes.get()), size};
}

#else

std::string png_bytes(const Picture& picture) {
    check(picture);
    throw std::runtime_error("png_bytes: built without libspng; install it (Debian: libspng-dev) and build again");
}

#endif

}  // namespace gaussmap
