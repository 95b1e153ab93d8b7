// Writes render/hud/font_table.cpp: the printable ASCII glyphs of a TrueType font as one-bit
// rasters. Needed only to change the font of the head-up display:
//   g++ -std=c++20 scripts/tools/make_font_table.cpp $(pkg-config --cflags --libs freetype2) -o
//   make
//   ./make DejaVuSans.ttf > render/hud/font_table.cpp
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cstdio>
#include <string>
#include <vector>

namespace {

constexpr int kEm = 64;  // must agree with kFontEm in render/hud/font_table.hpp

std::string base64(const std::vector<bool>& bits) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bits.size(); i += 6) {
    int digit = 0;
    for (std::size_t j = i; j < i + 6; ++j) {
      digit = 2 * digit + (j < bits.size() && bits[j] ? 1 : 0);
    }
    text.push_back(kDigits[digit]);
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  if (argc != 2 || FT_Init_FreeType(&library) != 0 ||
      FT_New_Face(library, argv[1], 0, &face) != 0 || FT_Set_Pixel_Sizes(face, 0, kEm) != 0) {
    std::fprintf(stderr, "usage: make_font_table FONT.ttf\n");
    return 2;
  }
  std::vector<bool> bits;
  std::string glyphs;
  for (unsigned long code = 32; code < 127; ++code) {
    FT_Load_Char(face, code, FT_LOAD_RENDER | FT_LOAD_TARGET_MONO | FT_LOAD_NO_HINTING);
    const FT_GlyphSlot slot = face->glyph;
    const FT_Bitmap& bitmap = slot->bitmap;
    glyphs += "    {" + std::to_string((slot->linearHoriAdvance + 0x8000) >> 16) + ", " +
              std::to_string(slot->bitmap_left) + ", " + std::to_string(slot->bitmap_top) + ", " +
              std::to_string(bitmap.width) + ", " + std::to_string(bitmap.rows) + ", " +
              std::to_string(bits.size()) + "},\n";
    for (unsigned row = 0; row < bitmap.rows; ++row) {
      for (unsigned column = 0; column < bitmap.width; ++column) {
        const unsigned char byte = bitmap.buffer[row * unsigned(bitmap.pitch) + column / 8];
        bits.push_back(((byte >> (7 - column % 8)) & 1) != 0);
      }
    }
  }
  std::printf(
      "// Made by scripts/tools/make_font_table.cpp from DejaVu Sans; do not edit.\n"
      "// DejaVu fonts: Copyright (c) 2003 by Bitstream, Inc. All Rights Reserved. Bitstream Vera\n"
      "// is a trademark of Bitstream, Inc. DejaVu changes are in public domain. The font's "
      "licence\n"
      "// allows to use, copy, embed and change it, under another name, with this notice.\n"
      "#include \"render/hud/font_table.hpp\"\n\nnamespace qsmpc {\n\n// clang-format off\n"
      "const std::array<GlyphMetrics, 95> glyph_metrics{{\n%s}};\n\n"
      "const char* const glyph_bits =\n",
      glyphs.c_str());
  const std::string text = base64(bits);
  for (std::size_t i = 0; i < text.size(); i += 92) {
    std::printf("    \"%s\"%s\n", text.substr(i, 92).c_str(), i + 92 < text.size() ? "" : ";");
  }
  std::printf("// clang-format on\n\n}  // namespace qsmpc\n");
  return 0;
}
