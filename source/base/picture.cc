// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/picture.h>
#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

namespace PeriDeal
{
  namespace
  {
    [[noreturn]] void refuse(const std::string &name, const std::string &what)
    {
      AssertThrow(false, UserError("'" + name + "' " + what));
      std::abort(); // not reached
    }


    void require_size(const std::string       &name,
                      const unsigned long long n_columns,
                      const unsigned long long n_rows)
    {
      if (n_columns == 0 || n_rows == 0)
        refuse(name, "has no pixels.");
      if (n_columns > most_pixels || n_rows > most_pixels || n_columns * n_rows > most_pixels)
        refuse(name,
               "is too large: " + std::to_string(n_columns) + " x " + std::to_string(n_rows) +
                 " pixels, more than the " + std::to_string(most_pixels) +
                 " that are read. Make it smaller.");
    }


    /**
     * A head may claim any size; the pixels are asked of the file before there is memory for them.
     */
    void require_enough(const std::string &name, const std::size_t available, const double needed)
    {
      if (static_cast<double>(available) < needed)
        refuse(name,
               "is cut short: the file is too small for as many pixels as it claims to have.");
    }


    // What libpng asks of us. It leaves a broken file by longjmp, so that nothing with a destructor
    // may live in the functions that call it.

    struct PNGSource
    {
      const char *bytes;
      std::size_t size, position;
      bool        ended;
      char        fault[120];
    };

    void png_give(png_structp png, png_bytep to, png_size_t n)
    {
      auto *source = static_cast<PNGSource *>(png_get_io_ptr(png));
      if (n > source->size - source->position)
        {
          source->ended = true;
          png_error(png, "the file ends too early");
        }
      std::memcpy(to, source->bytes + source->position, n);
      source->position += n;
    }

    void png_fail(png_structp png, png_const_charp message)
    {
      auto *source = static_cast<PNGSource *>(png_get_error_ptr(png));
      std::snprintf(source->fault, sizeof source->fault, "%s", message);
      png_longjmp(png, 1);
    }

    void png_ignore(png_structp, png_const_charp) {}


    /** Reading in two steps: size, then rows. */
    struct PNGReader
    {
      png_structp png;
      png_infop   info;
      png_uint_32 n_columns, n_rows;
    };

    /** Whether it went well. */
    bool read_head(PNGReader &reader, PNGSource &source)
    {
      if (setjmp(png_jmpbuf(reader.png)))
        return false;
      png_set_read_fn(reader.png, &source, png_give);
      png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff); // ours come next
      png_read_info(reader.png, reader.info);
      reader.n_columns = png_get_image_width(reader.png, reader.info);
      reader.n_rows    = png_get_image_height(reader.png, reader.info);
      return true;
    }

    /** @param indices the numbers of colours in the palette, a byte each, else pixels */
    bool read_rows(PNGReader &reader, const bool indices, png_bytep to)
    {
      if (setjmp(png_jmpbuf(reader.png)))
        return false;
      const std::size_t width = (indices ? 1 : 4) * std::size_t(reader.n_columns);
      if (indices)
        png_set_packing(reader.png); // less than 8 bits
      else
        {
          png_set_expand(reader.png);   // less than 8 bits, transparency
          png_set_scale_16(reader.png); // rounds
          png_set_gray_to_rgb(reader.png);
          png_set_add_alpha(reader.png, 255, PNG_FILLER_AFTER);
        }
      const int n_passes = png_set_interlace_handling(reader.png);
      png_read_update_info(reader.png, reader.info);
      for (int pass = 0; pass < n_passes; ++pass)
        for (png_uint_32 row = 0; row < reader.n_rows; ++row)
          png_read_row(reader.png, to + width * row, nullptr);
      png_read_end(reader.png, nullptr);
      return true;
    }


    /** libpng would take black for colours that the palette does not have. */
    void expand_palette(PNGReader                        &reader,
                        const std::vector<unsigned char> &indices,
                        const std::string                &name,
                        std::vector<Pixel>               &pixels)
    {
      png_colorp palette  = nullptr;
      png_bytep  opacity  = nullptr;
      int        n_colors = 0, n_opacities = 0;
      png_get_PLTE(reader.png, reader.info, &palette, &n_colors);
      png_get_tRNS(reader.png, reader.info, &opacity, &n_opacities, nullptr);
      for (std::size_t k = 0; k < indices.size(); ++k)
        {
          const int index = indices[k];
          if (index >= n_colors)
            refuse(name,
                   "is a broken PNG picture: it uses colour " + std::to_string(index + 1) +
                     " of a palette of " + std::to_string(n_colors) + ".");
          const png_color &color = palette[index];
          pixels[k]              = {color.red,
                                    color.green,
                                    color.blue,
                       index < n_opacities ? opacity[index] : std::uint8_t(255)};
        }
    }


    Picture decode_png(const std::string &bytes, const std::string &name)
    {
      PNGSource source{bytes.data(), bytes.size(), 0, false, ""};
      PNGReader reader{};
      reader.png  = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, png_fail, png_ignore);
      reader.info = reader.png == nullptr ? nullptr : png_create_info_struct(reader.png);
      AssertThrow(reader.info != nullptr, dealii::ExcMessage("libpng cannot be used."));
      struct Closer
      {
        PNGReader &reader;
        ~Closer()
        {
          png_destroy_read_struct(&reader.png, &reader.info, nullptr);
        }
      } const closer{reader};
      const auto require = [&](const bool ok) {
        if (!ok)
          refuse(name,
                 source.ended ?
                   "is cut short: the file ends before the picture does." :
                   std::string("is a broken PNG picture (libpng: ") + source.fault + ").");
      };
      require(read_head(reader, source));
      require_size(name, reader.n_columns, reader.n_rows);
      // Deflate makes 1032 bytes of one at most. Interlaced rows have the same bits in more rows.
      constexpr double most_packed = 1032.;
      const double     n_bits      = static_cast<double>(reader.n_columns) * reader.n_rows *
                            png_get_bit_depth(reader.png, reader.info) *
                            png_get_channels(reader.png, reader.info);
      require_enough(name, bytes.size(), n_bits / 8. / most_packed);
      Picture picture;
      picture.n_columns = reader.n_columns;
      picture.n_rows    = reader.n_rows;
      picture.pixels.resize(static_cast<std::size_t>(reader.n_columns) * reader.n_rows);
      if (png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_PALETTE)
        {
          std::vector<unsigned char> indices(picture.pixels.size());
          require(read_rows(reader, true, indices.data()));
          expand_palette(reader, indices, name, picture.pixels);
        }
      else
        require(read_rows(reader, false, picture.pixels.front().data()));
      return picture;
    }


    /** Reads the head, and the numbers, of a PGM or PPM file. */
    class PNMSource
    {
    public:
      PNMSource(const std::string &bytes, const std::string &name)
        : bytes(bytes)
        , name(name)
        , position(2)
      {}

      /** The next whole number of the text, after blanks and comments. */
      unsigned long number(const char *const what)
      {
        while (position < bytes.size() && (is_blank(bytes[position]) || bytes[position] == '#'))
          if (bytes[position] == '#')
            position = std::min(bytes.find('\n', position), bytes.size());
          else
            ++position;
        if (position >= bytes.size())
          refuse(name, "is cut short: the file ends before the picture does.");
        const std::size_t begin  = position;
        unsigned long     result = 0;
        while (position < bytes.size() && bytes[position] >= '0' && bytes[position] <= '9' &&
               position < begin + 10)
          result = 10 * result + static_cast<unsigned long>(bytes[position++] - '0');
        if (position == begin || (position < bytes.size() && !is_blank(bytes[position])))
          refuse(name,
                 std::string("is a broken picture: a whole number is expected for ") + what + ".");
        return result;
      }

      /** The next one or two bytes of the binary part. */
      unsigned long sample(const bool two_bytes)
      {
        unsigned long result = static_cast<unsigned char>(bytes[position++]);
        if (two_bytes)
          result = 256 * result + static_cast<unsigned char>(bytes[position++]);
        return result;
      }

      /** Leave the blank after the head; that many bytes have to follow. */
      void begin_binary(const std::size_t n_bytes)
      {
        ++position;
        if (position > bytes.size() || n_bytes > bytes.size() - position)
          refuse(name, "is cut short: the file ends before the picture does.");
      }

    private:
      static bool is_blank(const char c)
      {
        return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
      }

      const std::string &bytes, &name;
      std::size_t        position;
    };


    Picture decode_pnm(const std::string &bytes, const std::string &name)
    {
      const bool          is_text = bytes[1] < '4', colored = bytes[1] == '3' || bytes[1] == '6';
      PNMSource           source(bytes, name);
      const unsigned long n_columns = source.number("its width"),
                          n_rows    = source.number("its height");
      require_size(name, n_columns, n_rows);
      const unsigned long largest = source.number("its largest value");
      if (largest == 0 || largest > 65535)
        refuse(name,
               "is a broken picture: its largest value is " + std::to_string(largest) +
                 ", not one from 1 to 65535.");
      const std::size_t n        = static_cast<std::size_t>(n_columns) * n_rows;
      const bool        two      = largest > 255;
      const unsigned    n_values = colored ? 3 : 1;
      if (is_text) // a digit and a blank
        require_enough(name, bytes.size(), 2. * n * n_values - 1.);
      else
        source.begin_binary(n * n_values * (two ? 2 : 1));
      Picture picture;
      picture.n_columns = static_cast<unsigned int>(n_columns);
      picture.n_rows    = static_cast<unsigned int>(n_rows);
      picture.pixels.resize(n);
      for (Pixel &pixel : picture.pixels)
        {
          for (unsigned int c = 0; c < n_values; ++c)
            {
              const unsigned long value = is_text ? source.number("a pixel") : source.sample(two);
              if (value > largest)
                refuse(name,
                       "is a broken picture: the value " + std::to_string(value) +
                         " is larger than its largest value, " + std::to_string(largest) + ".");
              pixel[c] = static_cast<std::uint8_t>((value * 255 + largest / 2) / largest);
            }
          if (!colored)
            pixel[1] = pixel[2] = pixel[0];
          pixel[3] = 255;
        }
      return picture;
    }


    void png_append(png_structp png, png_bytep from, png_size_t n)
    {
      static_cast<std::string *>(png_get_io_ptr(png))->append(reinterpret_cast<char *>(from), n);
    }

    void png_finish(png_structp) {}
  } // namespace


  Picture decode_picture(const std::string &bytes, const std::string &name)
  {
    static const std::string png_mark = "\x89PNG\r\n\x1a\n";
    if (bytes.empty())
      refuse(name, "is empty.");
    if (bytes.compare(0, png_mark.size(), png_mark) == 0)
      return decode_png(bytes, name);
    if (bytes.size() > 2 && bytes[0] == 'P' && std::strchr("2356", bytes[1]) != nullptr)
      return decode_pnm(bytes, name);
    refuse(name, "is no picture that can be read: PNG, PGM or PPM.");
  }


  Picture read_picture(const std::string &file_name, const MPI_Comm communicator)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    Picture     picture;
    std::string message;
    if (rank == 0)
      try
        {
          std::string       fault;
          const std::string bytes = read_file(file_name, most_bytes_of_data, fault);
          if (!fault.empty())
            refuse(
              file_name,
              fault +
                ". Check its path, relative to the working directory or to the folder of the scene file.");
          picture = decode_picture(bytes, file_name);
        }
      catch (const UserError &error)
        {
          message = error.message();
        }
    throw_on_all_if_any(communicator, message);
    unsigned int size[2] = {picture.n_columns, picture.n_rows};
    MPI_Bcast(size, 2, MPI_UNSIGNED, 0, communicator);
    picture.n_columns = size[0];
    picture.n_rows    = size[1];
    picture.pixels.resize(static_cast<std::size_t>(size[0]) * size[1]);
    MPI_Bcast(picture.pixels.data(),
              static_cast<int>(4 * picture.pixels.size()),
              MPI_UNSIGNED_CHAR,
              0,
              communicator);
    return picture;
  }


  std::string encode_png(const Picture &picture)
  {
    std::string bytes;
    png_structp png  = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, png_ignore);
    png_infop   info = png == nullptr ? nullptr : png_create_info_struct(png);
    AssertThrow(info != nullptr, dealii::ExcMessage("libpng cannot be used."));
    std::vector<Pixel> pixels = picture.pixels; // libpng wants to be able to change them
    png_set_write_fn(png, &bytes, png_append, png_finish);
    png_set_IHDR(png,
                 info,
                 picture.n_columns,
                 picture.n_rows,
                 8,
                 PNG_COLOR_TYPE_RGB_ALPHA,
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (unsigned int row = 0; row < picture.n_rows; ++row)
      png_write_row(png, pixels[static_cast<std::size_t>(row) * picture.n_columns].data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
  }
} // namespace PeriDeal
