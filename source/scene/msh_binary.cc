// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Binary Gmsh files, written out as the text that the same program saves without -bin.

#include <perideal/scene/msh_file.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "msh_error.h"

namespace PeriDeal
{
  namespace
  {
    const std::string remedy =
      " Save it as text (in Gmsh: without -bin, Mesh.Binary = 0), or as version 4.1.";


    /** Nodes of the types of elements that a parser of text knows by name; 0 of others. */
    unsigned int n_nodes_of_type(const int type)
    {
      constexpr std::array<unsigned int, 8> n{{0, 2, 3, 4, 4, 8, 6, 5}};
      return type == 15 ? 1 : type > 0 && type < 8 ? n[type] : 0;
    }


    class Converter
    {
    public:
      Converter(const std::string &bytes, const std::string &name)
        : bytes(bytes)
        , name(name)
      {
        text << std::setprecision(17);
      }

      std::string convert()
      {
        std::string first;
        for (bool in_comments = false; first != "$MeshFormat"; first = line())
          {
            if (position == bytes.size() || !(in_comments || first.empty() || first[0] == '$'))
              return "";
            in_comments = first == "$Comments" || (in_comments && first != "$EndComments");
          }
        std::istringstream header(line());
        std::string        version, kind, size;
        header >> version >> kind >> size;
        if (kind != "1")
          return "";
        const bool latest = version == "4.1";
        if ((!latest && version.substr(0, 2) != "2." && version != "2") || size != "8")
          error("it is binary and of version " + version + ", of which binary files are not read." +
                remedy);
        if (whole() != 1)
          error(
            "it is binary and has the byte order of another kind of machine. Save it as text (in Gmsh: without -bin, Mesh.Binary = 0).");
        text << "$MeshFormat\n" << version << " 0 8\n";
        // What lies between sections is text; comments may hold anything.
        for (std::string title = next_line(); title != "$Elements"; title = next_line())
          {
            if (title == "$PartitionedEntities" || title == "$Comments")
              {
                const std::size_t end = bytes.find("$End" + title.substr(1), position);
                if (end == std::string::npos)
                  error("the file is broken: it ends within " + title + ".");
                position = end;
                text << (title == "$Comments" ? "" : title + "\n");
                if (title == "$Comments")
                  next_line();
                continue;
              }
            text << title << "\n";
            if (title == "$Entities" && latest)
              entities();
            else if (title == "$Nodes")
              latest ? nodes() : old_nodes();
          }
        text << "$Elements\n";
        if (latest ? elements() : old_elements())
          text << "$EndElements\n";
        return text.str();
      }

    private:
      [[noreturn]] void error(const std::string &what) const
      {
        msh_error(name, 2, what); // the line that says that it is binary
      }

      /** The rest of a line of text. */
      std::string line()
      {
        const std::size_t begin = position, end = bytes.find('\n', begin);
        position = end == std::string::npos ? bytes.size() : end + 1;
        std::string found =
          bytes.substr(begin, (end == std::string::npos ? bytes.size() : end) - begin);
        if (!found.empty() && found.back() == '\r')
          found.pop_back();
        return found;
      }

      /** The next line that is not empty. */
      std::string next_line()
      {
        while (position < bytes.size())
          if (const std::string found = line(); !found.empty())
            return found;
        error("the file is broken: it ends before '$Elements'.");
      }

      template <typename T>
      T read()
      {
        if (position + sizeof(T) > bytes.size())
          error("the file is broken: it ends within its binary numbers.");
        T value;
        std::memcpy(&value, bytes.data() + position, sizeof(T));
        position += sizeof(T);
        return value;
      }

      std::int32_t whole()
      {
        return read<std::int32_t>();
      }

      std::uint64_t large()
      {
        return read<std::uint64_t>();
      }

      /** Write a number that counts things of some bytes each, which have to be there. */
      std::uint64_t count(const std::uint64_t n, const std::size_t size)
      {
        if (n > (bytes.size() - position) / size)
          error("the file is broken: it counts " + std::to_string(n) +
                " things that it does not have.");
        text << n << " ";
        return n;
      }

      void entities()
      {
        std::array<std::uint64_t, 4> n;
        for (auto &one : n)
          one = count(large(), 1);
        text << "\n";
        for (unsigned int d = 0; d < 4; ++d)
          for (std::uint64_t i = 0; i < n[d]; ++i)
            {
              text << whole() << " ";
              for (unsigned int k = 0; k < (d == 0 ? 3 : 6); ++k)
                text << read<double>() << " ";
              for (unsigned int list = 0; list < (d == 0 ? 1 : 2); ++list)
                for (std::uint64_t k = count(large(), 4); k > 0; --k)
                  text << whole() << " ";
              text << "\n";
            }
      }

      void nodes()
      {
        std::uint64_t n_blocks = count(large(), 1);
        text << large() << " " << large() << " " << large() << "\n";
        for (; n_blocks > 0; --n_blocks)
          {
            text << whole() << " " << whole() << " ";
            const int parametric = whole();
            text << parametric << " ";
            const std::uint64_t n = count(large(), 8);
            text << "\n";
            if (parametric != 0) // which the parser refuses at this place
              error("parametric coordinates of nodes are not read. Save the file without them (in "
                    "Gmsh: Mesh.SaveParametric = 0).");
            for (std::uint64_t i = 0; i < n; ++i)
              text << large() << "\n";
            for (std::uint64_t i = 0; i < n; ++i)
              point();
          }
      }

      void point()
      {
        for (unsigned int d = 0; d < 3; ++d)
          text << read<double>() << (d < 2 ? " " : "\n");
      }

      void old_nodes()
      {
        const std::string n = line();
        text << n << "\n";
        for (long i = std::atol(n.c_str()); i > 0; --i)
          {
            text << whole() << " ";
            point();
          }
      }

      /** @return whether all could be read: the parser refuses a type that is unknown */
      bool elements()
      {
        std::uint64_t n_blocks = count(large(), 1);
        text << large() << " " << large() << " " << large() << "\n";
        for (; n_blocks > 0; --n_blocks)
          {
            text << whole() << " " << whole() << " ";
            const int type = whole();
            text << type << " ";
            const std::uint64_t n = count(large(), 8);
            text << "\n";
            if (n_nodes_of_type(type) == 0)
              return false;
            for (std::uint64_t i = 0; i < n; ++i)
              {
                for (unsigned int k = 0; k < n_nodes_of_type(type) + 1; ++k)
                  text << large() << " ";
                text << "\n";
              }
          }
        return true;
      }

      bool old_elements()
      {
        const std::string n = line();
        text << n << "\n";
        for (long left = std::atol(n.c_str()); left > 0;)
          {
            const int type = whole(), n_here = whole(), n_tags = whole();
            if (n_here < 1 || n_here > left || n_tags < 0)
              error("the file is broken: a block of " + std::to_string(n_here) + " elements, " +
                    std::to_string(left) + " are left.");
            for (int i = 0; i < n_here; ++i, --left)
              {
                text << whole() << " " << type << " " << n_tags << " ";
                if (n_nodes_of_type(type) == 0)
                  return false;
                for (unsigned int k = 0; k < n_tags + n_nodes_of_type(type); ++k)
                  text << whole() << " ";
                text << "\n";
              }
          }
        return true;
      }

      const std::string &bytes, &name;
      std::size_t        position = 0;
      std::ostringstream text;
    };
  } // namespace


  std::string text_of_binary_msh(const std::string &bytes, const std::string &name)
  {
    return Converter(bytes, name).convert();
  }
} // namespace PeriDeal
