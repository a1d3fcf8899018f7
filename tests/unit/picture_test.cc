// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/picture.h>

#include <png.h>

#include <fstream>

#include "scene_test_tools.h"

using namespace PeriDeal;
using PeriDeal::SceneTests::expect_parts;
using PeriDeal::SceneTests::message_of;

namespace
{
  using Row = std::vector<unsigned char>;

  /** A PNG file of any kind, from packed rows. */
  std::string png_file(const int                     color_type,
                       const int                     depth,
                       const unsigned int            width,
                       std::vector<Row>              rows,
                       const std::vector<png_color> &palette      = {},
                       const Row                    &transparency = {},
                       const bool                    interlaced   = false)
  {
    std::string bytes;
    png_structp png  = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop   info = png_create_info_struct(png);
    png_set_check_for_invalid_index(png, 0); // newer ones would not write it
    png_set_write_fn(
      png,
      &bytes,
      [](png_structp p, png_bytep from, png_size_t n) {
        static_cast<std::string *>(png_get_io_ptr(p))->append(reinterpret_cast<char *>(from), n);
      },
      [](png_structp) {});
    png_set_IHDR(png,
                 info,
                 width,
                 static_cast<png_uint_32>(rows.size()),
                 depth,
                 color_type,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!palette.empty())
      png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    if (!transparency.empty())
      png_set_tRNS(png, info, transparency.data(), static_cast<int>(transparency.size()), nullptr);
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (Row &row : rows)
      pointers.push_back(row.data());
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
  }


  void expect_pixels(const std::string        &bytes,
                     const unsigned int        width,
                     const std::vector<Pixel> &pixels)
  {
    const Picture picture = decode_picture(bytes, "test");
    EXPECT_EQ(picture.n_columns, width);
    EXPECT_EQ(picture.n_rows, pixels.size() / width);
    EXPECT_EQ(picture.pixels, pixels);
  }


  Pixel grey(const unsigned int value, const unsigned int alpha = 255)
  {
    const auto g = static_cast<std::uint8_t>(value);
    return {g, g, g, static_cast<std::uint8_t>(alpha)};
  }


  void expect_fault(const std::string &bytes, const std::vector<std::string> &parts)
  {
    const std::string message = message_of([&] { decode_picture(bytes, "wire.png"); });
    expect_parts(message, parts);
    expect_parts(message, {"'wire.png'"});
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
} // namespace


TEST(Picture, png_of_greys)
{
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 1, 3, {{0xA0}, {0x40}}),
                3,
                {grey(255), grey(0), grey(255), grey(0), grey(255), grey(0)});
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 2, 4, {{0x1B}}),
                4,
                {grey(0), grey(85), grey(170), grey(255)});
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 4, 2, {{0x0F}, {0x82}}),
                2,
                {grey(0), grey(255), grey(136), grey(34)});
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 8, 2, {{7, 200}}), 2, {grey(7), grey(200)});
  // 16 bits: 0x1234 is 4660, of 65535 18.13 parts in 255; 0x12FF is 18.93
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 16, 3, {{0x12, 0x34, 0xFF, 0xFF, 0x12, 0xFF}}),
                3,
                {grey(18), grey(255), grey(19)});
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2, {{7, 0, 200, 128}}),
                2,
                {grey(7, 0), grey(200, 128)});
}


TEST(Picture, png_of_colors)
{
  expect_pixels(png_file(PNG_COLOR_TYPE_RGB, 8, 2, {{1, 2, 3, 255, 128, 0}}),
                2,
                {{1, 2, 3, 255}, {255, 128, 0, 255}});
  expect_pixels(png_file(PNG_COLOR_TYPE_RGB_ALPHA, 8, 1, {{1, 2, 3, 4}, {5, 6, 7, 8}}),
                1,
                {{1, 2, 3, 4}, {5, 6, 7, 8}});
  expect_pixels(png_file(PNG_COLOR_TYPE_RGB_ALPHA, 16, 1, {{1, 0, 2, 0, 3, 0, 255, 255}}),
                1,
                {{1, 2, 3, 255}});
  const std::vector<png_color> palette{{255, 0, 0}, {0, 255, 0}, {10, 20, 30}};
  expect_pixels(png_file(PNG_COLOR_TYPE_PALETTE, 2, 3, {{0x18}}, palette),
                3,
                {{255, 0, 0, 255}, {0, 255, 0, 255}, {10, 20, 30, 255}});
  expect_pixels(png_file(PNG_COLOR_TYPE_PALETTE, 8, 2, {{2, 0}}, palette, {9, 255}),
                2,
                {{10, 20, 30, 255}, {255, 0, 0, 9}});
}


TEST(Picture, interlaced_png_and_own_png)
{
  std::vector<Row>   rows;
  std::vector<Pixel> pixels;
  Picture            picture;
  picture.n_columns = 13;
  picture.n_rows    = 9;
  for (unsigned int r = 0; r < 9; ++r)
    {
      rows.emplace_back();
      for (unsigned int c = 0; c < 13; ++c)
        {
          rows.back().push_back(static_cast<unsigned char>(20 * r + c));
          pixels.push_back(grey(20 * r + c));
          picture.pixels.push_back(
            {static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(c), 77, 200});
        }
    }
  expect_pixels(png_file(PNG_COLOR_TYPE_GRAY, 8, 13, rows, {}, {}, true), 13, pixels);
  EXPECT_EQ(decode_picture(encode_png(picture), "own").pixels, picture.pixels);
}


TEST(Picture, pgm_and_ppm)
{
  const std::vector<Pixel> greys{grey(0), grey(85), grey(255)};
  expect_pixels("P2\n# a comment\n3 1 # another\n3\n0 1\n3\n", 3, greys);
  expect_pixels(std::string("P5 3 1 3\n\0\1\3", 12), 3, greys);
  expect_pixels(std::string("P5\n2 1\n65535\n\x12\x34\xFF\xFF", 17), 2, {grey(18), grey(255)});
  expect_pixels("P3 1 2 255  1 2 3  255 128 0", 1, {{1, 2, 3, 255}, {255, 128, 0, 255}});
  expect_pixels(std::string("P6 1 2 255\n\1\2\3\xFF\x80\0", 17),
                1,
                {{1, 2, 3, 255}, {255, 128, 0, 255}});
}


TEST(Picture, mistakes)
{
  const std::string png = png_file(PNG_COLOR_TYPE_GRAY, 8, 40, std::vector<Row>(40, Row(40, 9)));
  expect_fault("", {"empty"});
  expect_fault("GIF89a...", {"no picture", "PNG, PGM or PPM"});
  expect_fault("P1 2 2 0 1 1 0", {"no picture"});
  expect_fault(png.substr(0, 20), {"cut short"});
  expect_fault(png.substr(0, png.size() - 30), {"cut short"});
  std::string broken = png;
  broken[png.find("IDAT") + 7] ^= 0x55; // behind the last row newer libpng looks at nothing
  expect_fault(broken, {"broken PNG"});
  std::string checksum = png;
  checksum[29] ^= 1; // of the head
  expect_fault(checksum, {"broken PNG"});
  const std::vector<png_color> palette{{255, 0, 0}, {0, 255, 0}, {10, 20, 30}};
  expect_fault(png_file(PNG_COLOR_TYPE_PALETTE, 2, 3, {{0x1C}}, palette),
               {"broken PNG", "colour 4", "palette of 3"});
  expect_fault("P2 3 1 255 1 2", {"cut short"});
  expect_fault("P5 3 1 255\n12", {"cut short"});
  expect_fault("P2 3 1 255 1 x 2", {"broken", "whole number"});
  expect_fault("P2 3 1 10 1 11 2", {"broken", "11", "10"});
  expect_fault("P2 3 1 0 0 0 0", {"largest value"});
  expect_fault("P2 0 1 255", {"no pixels"});
  expect_fault("P5 1000000 1000000 255\n", {"too large", "1000000 x 1000000"});
  std::string huge = png; // the width in the head, and its checksum
  huge[16]         = 0x40;
  expect_fault(huge, {"'wire.png'"});
}


/**
 * The head of a file can claim any size, with a right checksum; memory is taken only for what the
 * file can hold.
 */
TEST(Picture, sizes_that_are_claimed)
{
  const std::string small = png_file(PNG_COLOR_TYPE_RGB, 8, 2, {{1, 2, 3, 255, 128, 0}});
  const auto        claim = [&](const unsigned int width, const unsigned int height) {
    std::string head = small.substr(12, 17); // IHDR and its data
    for (unsigned int k = 0; k < 4; ++k)
      {
        head[4 + k] = static_cast<char>(width >> (24 - 8 * k));
        head[8 + k] = static_cast<char>(height >> (24 - 8 * k));
      }
    unsigned int sum = ~0u;
    for (const char c : head)
      {
        sum ^= static_cast<unsigned char>(c);
        for (unsigned int k = 0; k < 8; ++k)
          sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320u : 0u);
      }
    std::string check(4, '\0');
    for (unsigned int k = 0; k < 4; ++k)
      check[k] = static_cast<char>(~sum >> (24 - 8 * k));
    return small.substr(0, 12) + head + check + small.substr(33);
  };
  EXPECT_EQ(decode_picture(claim(2, 1), "test").pixels.size(), 2u);
  expect_fault(claim(10000, 10000), {"cut short", "too small for as many pixels"});
  expect_fault(claim(100000, 100000), {"too large"});
  expect_fault(claim(2, 3), {"broken PNG"});
  expect_fault(claim(0, 1), {"broken PNG"});
  expect_fault(claim(1, 0), {"broken PNG"});
  expect_fault(claim(0x80000000u, 1), {"broken PNG"});
  expect_fault("P2 10000 10000 255 1 2 3", {"cut short", "too small for as many pixels"});
  expect_fault("P6 10000 10000 255 123", {"cut short"});
}


TEST(Picture, all_processes_read_the_same)
{
  const std::string name = "picture_test.pgm";
  int               rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    std::ofstream(name) << "P2 2 1 255 17 99";
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(read_picture(name, MPI_COMM_WORLD).pixels, (std::vector<Pixel>{grey(17), grey(99)}));
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0)
    std::remove(name.c_str());
  MPI_Barrier(MPI_COMM_WORLD);
  expect_parts(message_of([&] { read_picture(name, MPI_COMM_WORLD); }), {name, "cannot be read"});
  expect_parts(message_of([&] { read_picture(".", MPI_COMM_WORLD); }), {"'.'", "cannot be read"});
}
