// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/mesh/msh_check.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>

#include "msh_error.h"

namespace PeriDeal
{
  void msh_error(const std::string &name, const unsigned int line, const std::string &what)
  {
    AssertThrow(false,
                UserError("'Mesh file' in section 'Domain': '" + name + "', line " +
                          std::to_string(line) + ": " + what));
    std::abort(); // not reached
  }


  namespace
  {
    const std::string supported =
      " PeriDeal reads Gmsh files (.msh, versions 2.2 and 4.1 as text) of quadrilaterals in 2D and hexahedra in 3D only "
      "(in Gmsh: recombine all surfaces, or use transfinite or extruded volumes).";


    /** The words of a file, with their lines. */
    class Words
    {
    public:
      Words(const std::string &text, const std::string &name)
        : text(text)
        , name(name)
      {}

      /** The next word; at the end of the file an error that says what is missing. */
      std::string_view next(const std::string &expected)
      {
        while (position < text.size() && is_blank(text[position]))
          {
            line += text[position] == '\n' ? 1 : 0;
            ++position;
          }
        const std::size_t begin = position;
        while (position < text.size() && !is_blank(text[position]))
          ++position;
        if (begin == position)
          broken("the file ends", expected);
        return std::string_view(text).substr(begin, position - begin);
      }

      double real(const std::string &what)
      {
        const std::string word(next(what));
        char             *end   = nullptr;
        const double      value = std::strtod(word.c_str(), &end);
        if (*end != '\0' || word.find_first_not_of("0123456789+-.eE") != std::string::npos)
          broken("found '" + shortened(word) + "'", what);
        if (!(std::abs(value) < 1e100)) // squares and products have to be finite, too
          broken("found " + shortened(word) + ", which is too large", what);
        return value;
      }

      int whole(const std::string &what, const long lowest, const long highest)
      {
        const std::string word(next(what));
        const bool        digits = word.size() < 12 &&
                            word.find_first_not_of("0123456789", word[0] == '-' ? 1 : 0) ==
                              std::string::npos;
        char      *end   = nullptr;
        const long value = std::strtol(word.c_str(), &end, 10);
        if (!digits || *end != '\0')
          broken("found '" + shortened(word) + "'", what);
        if (value < lowest || value > highest)
          broken("found " + word,
                 what + (highest == largest ?
                           ", " + std::to_string(lowest) + " or more" :
                           ", from " + std::to_string(lowest) + " to " + std::to_string(highest)));
        return static_cast<int>(value);
      }

      /** A number of things that follow, of which each takes two letters at least. */
      int count(const std::string &what)
      {
        const int n = whole(what, 0, largest);
        if (static_cast<std::size_t>(n) > (text.size() - position) / 2 + 1)
          broken("found " + std::to_string(n) + ", more than the rest of the file can hold", what);
        return n;
      }

      void skip_to(const std::string &end)
      {
        while (next("'" + end + "'") != end)
          {}
      }

      void require(const std::string &expected)
      {
        const std::string word(next("'" + expected + "'"));
        if (word != expected)
          broken("found '" + shortened(word) + "'", "'" + expected + "'");
      }

      [[noreturn]] void broken(const std::string &found, const std::string &expected) const
      {
        msh_error(name, line, "the file is broken: " + found + ", expected " + expected + ".");
      }

      [[noreturn]] void error(const std::string &what) const
      {
        msh_error(name, line, what);
      }

      unsigned int line_number() const
      {
        return line;
      }

      static constexpr long largest = 2147483646;

    private:
      static bool is_blank(const char c)
      {
        return std::isspace(static_cast<unsigned char>(c)) != 0;
      }

      static std::string shortened(const std::string &word)
      {
        std::string result = word.size() > 40 ? word.substr(0, 40) + "..." : word;
        for (char &c : result) // of a file that is no text
          if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || static_cast<signed char>(c) < 0)
            c = '?';
        return result;
      }

      const std::string &text, &name;
      std::size_t        position = 0;
      unsigned int       line     = 1;
    };


    const char *type_name(const int type)
    {
      switch (type)
        {
          case 1:
            return "line";
          case 2:
            return "triangle";
          case 3:
            return "quadrilateral";
          case 4:
            return "tetrahedron";
          case 5:
            return "hexahedron";
          case 6:
            return "prism";
          case 7:
            return "pyramid";
          case 15:
            return "point";
          default:
            return nullptr;
        }
    }


    class Parser
    {
    public:
      Parser(const std::string &text, const std::string &name, const unsigned int dim)
        : words(text, name)
        , dim(dim)
      {}

      MshMesh parse()
      {
        read_header();
        std::string section(words.next("'$Nodes'"));
        const auto  skip = [&](const std::string &title) {
          if (section != "$" + title)
            return;
          words.skip_to("$End" + title);
          section = words.next("'$Nodes'");
        };
        skip("PhysicalNames");
        if (section == "$Entities")
          {
            read_entities();
            section = words.next("'$Nodes'");
          }
        partitioned = section == "$PartitionedEntities";
        skip("PartitionedEntities");
        if (section != "$Nodes")
          words.broken("found '" + section.substr(0, 40) + "'", "'$Nodes'");
        read_nodes();
        words.require("$EndNodes");
        words.require("$Elements");
        read_elements();
        words.require("$EndElements");
        if (mesh.cells.empty())
          words.error("the file has no " +
                      std::string(dim == 3 ? "hexahedra" :
                                  dim == 2 ? "quadrilaterals" :
                                             "lines") +
                      ", of which a mesh of dimension " + std::to_string(dim) + " consists." +
                      supported);
        return std::move(mesh);
      }

    private:
      void read_header()
      {
        const std::string first(words.next("'$MeshFormat'"));
        if (first == "$NOD")
          words.error("this is Gmsh's version 1." + supported);
        if (first != "$MeshFormat")
          words.error(
            "this is no Gmsh file, or it is broken: it does not begin with '$MeshFormat'." +
            supported);
        const std::string           version(words.next("the version of the format"));
        const std::set<std::string> two{"2", "2.0", "2.1", "2.2"}, four{"4", "4.0"};
        if (two.count(version) == 0 && four.count(version) == 0 && version != "4.1")
          words.error("found version '" + version.substr(0, 40) + "' of the format." + supported);
        is_old         = two.count(version) > 0;
        is_latest      = version == "4.1";
        const int kind = words.whole("the kind of the file, 0 (text)", 0, Words::largest);
        if (kind != 0)
          words.error("the file is binary, or broken: save it as text (in Gmsh: without -bin, "
                      "Mesh.Binary = 0).");
        words.whole("the size of a number, 8 bytes", 8, 8);
        words.require("$EndMeshFormat");
      }


      void read_entities()
      {
        if (is_old)
          words.broken("found '$Entities', which version 2 does not have", "'$Nodes'");
        std::array<int, 4> n;
        for (unsigned int d = 0; d < 4; ++d)
          n[d] = words.count("the number of entities of dimension " + std::to_string(d));
        for (unsigned int d = 0; d < 4; ++d)
          for (int i = 0; i < n[d]; ++i)
            {
              const std::string what =
                "entity " + std::to_string(i + 1) + " of dimension " + std::to_string(d);
              const int tag = words.whole("the number of " + what, -Words::largest, Words::largest);
              for (unsigned int k = 0; k < (d == 0 && is_latest ? 3 : 6); ++k)
                words.real("a coordinate of " + what);
              const int n_physical = words.count("the number of physical groups of " + what);
              if (n_physical > 1)
                words.error(what + " is in " + std::to_string(n_physical) +
                            " physical groups, where one is allowed (or the file is broken).");
              int id = 0;
              if (n_physical == 1)
                id = words.whole("the physical group of " + what, 0, Words::largest);
              if (d > 0)
                {
                  const int n_around = words.count("the number of entities around " + what);
                  for (int k = 0; k < n_around; ++k)
                    words.whole("an entity around " + what, -Words::largest, Words::largest);
                }
              if (!ids.insert({{static_cast<int>(d), tag}, id}).second)
                words.broken("found number " + std::to_string(tag) + " twice",
                             "each entity of dimension " + std::to_string(d) + " once");
            }
        words.require("$EndEntities");
        has_entities = true;
      }


      void read_node(const int number)
      {
        const unsigned int index = mesh.points.size();
        if (!index_of.insert({number, index}).second)
          words.broken("found node " + std::to_string(number) + " twice", "each number once");
        mesh.numbers.push_back(number);
      }


      void read_point(const int number)
      {
        mesh.points.emplace_back();
        for (unsigned int d = 0; d < 3; ++d)
          mesh.points.back()[d] =
            words.real(std::string(1, "xyz"[d]) + " of node " + std::to_string(number));
      }


      int node_number()
      {
        return words.whole("the number of a node", 1, Words::largest);
      }


      void read_nodes()
      {
        const int n_blocks = is_old ? 1 : words.count("the number of blocks of nodes");
        const int n_nodes  = words.count("the number of nodes");
        if (is_latest)
          read_range("node");
        for (int block = 0; block < n_blocks; ++block)
          {
            int n = n_nodes;
            if (!is_old)
              {
                read_entity();
                if (words.whole("0 (no parametric coordinates)", 0, 1) == 1)
                  words.error("parametric coordinates of nodes are not read. Save the file without "
                              "them (in Gmsh: Mesh.SaveParametric = 0).");
                n = words.count("the number of nodes in this block");
                if (n > n_nodes - static_cast<int>(mesh.points.size()))
                  words.broken("found " + std::to_string(n) + " nodes in this block",
                               "no more than " + std::to_string(n_nodes) +
                                 " in all, as '$Nodes' says");
              }
            if (is_latest)
              {
                // all numbers come first
                const std::size_t before = mesh.numbers.size();
                for (int i = 0; i < n; ++i)
                  {
                    const int number = node_number();
                    if (!index_of.insert({number, before + i}).second)
                      words.broken("found node " + std::to_string(number) + " twice",
                                   "each number once");
                    mesh.numbers.push_back(number);
                  }
                for (int i = 0; i < n; ++i)
                  read_point(mesh.numbers[before + i]);
              }
            else
              for (int i = 0; i < n; ++i)
                {
                  read_node(node_number());
                  read_point(mesh.numbers.back());
                }
          }
        if (static_cast<int>(mesh.points.size()) != n_nodes)
          words.broken("found " + std::to_string(mesh.points.size()) + " nodes in all blocks",
                       std::to_string(n_nodes) + ", as '$Nodes' says");
      }


      void read_range(const std::string &what)
      {
        words.whole("the smallest number of a " + what, 0, Words::largest);
        words.whole("the largest number of a " + what, 0, Words::largest);
      }


      /** Dimension and number of the entity of a block. */
      std::pair<int, int> read_entity()
      {
        int dimension = 0, tag = 0;
        for (const bool is_dimension : {is_latest, !is_latest})
          if (is_dimension)
            dimension = words.whole("the dimension of an entity", 0, 3);
          else
            tag = words.whole("the number of an entity", -Words::largest, Words::largest);
        return {dimension, tag};
      }


      void read_elements()
      {
        const int n_blocks   = is_old ? 1 : words.count("the number of blocks of elements");
        const int n_elements = words.count("the number of elements");
        if (is_latest)
          read_range("element");
        int n_read = 0;
        for (int block = 0; block < n_blocks; ++block)
          {
            int n = n_elements, id = 0, type = 0;
            if (!is_old)
              {
                const auto entity = read_entity();
                type              = read_type();
                const int of_type = type == 15 ? 0 : type == 1 ? 1 : type < 4 ? 2 : 3;
                if (of_type != entity.first)
                  words.broken("found a " + std::string(type_name(type)) +
                                 " in an entity of dimension " + std::to_string(entity.first),
                               "an element of that dimension");
                const auto found = ids.find(entity);
                if (found == ids.end() && has_entities && !partitioned)
                  words.broken("found entity " + std::to_string(entity.second) + " of dimension " +
                                 std::to_string(entity.first),
                               "one that '$Entities' lists");
                id = found == ids.end() ? 0 : found->second;
                n  = words.count("the number of elements in this block");
                if (n > n_elements - n_read)
                  words.broken("found " + std::to_string(n) + " elements in this block",
                               "no more than " + std::to_string(n_elements) +
                                 " in all, as '$Elements' says");
              }
            for (int i = 0; i < n; ++i)
              read_element(type, id);
            n_read += n;
          }
        if (n_read != n_elements)
          words.broken("found " + std::to_string(n_read) + " elements in all blocks",
                       std::to_string(n_elements) + ", as '$Elements' says");
      }


      /** A type that a mesh of this dimension can have. */
      int read_type()
      {
        const int   type  = words.whole("the type of an element", 1, 1000);
        const char *title = type_name(type);
        if (title == nullptr)
          words.error("found an element of type " + std::to_string(type) +
                      ", which is of higher order or none of Gmsh's." + supported);
        const bool can = type == 15 || type == 1 || (type == 3 && dim > 1) ||
                         (type == 5 && dim > 2);
        if (!can)
          words.error("found a " + std::string(title) + ", which a mesh of dimension " +
                      std::to_string(dim) + " that can be used does not have." + supported);
        return type;
      }


      /** @param type,id of its block; with version 2 they stand with the element */
      void read_element(int type, int id)
      {
        MshElement element;
        element.number = words.whole("the number of an element", 0, Words::largest);
        element.line   = words.line_number();
        if (!elements.insert({element.number, element.line}).second)
          words.broken("found element " + std::to_string(element.number) +
                         " for the second time, first in line " +
                         std::to_string(elements.at(element.number)),
                       "each number once");
        if (is_old)
          {
            type             = read_type();
            const int n_tags = words.count("the number of tags of an element");
            id               = 0;
            for (int k = 0; k < n_tags; ++k)
              {
                // partitions may be negative, the first tag is the physical group
                const int tag = words.whole("a tag of element " + std::to_string(element.number),
                                            k == 0 ? 0 : -Words::largest,
                                            Words::largest);
                id            = k == 0 ? tag : id;
              }
          }
        element.id = id;
        element.n  = type == 15 ? 1 : type == 1 ? 2 : type == 3 ? 4 : 8;
        for (unsigned int k = 0; k < element.n; ++k)
          {
            const int number =
              words.whole("a node of element " + std::to_string(element.number), 1, Words::largest);
            const auto found = index_of.find(number);
            if (found == index_of.end())
              words.broken("found node " + std::to_string(number) + " in element " +
                             std::to_string(element.number),
                           "one that '$Nodes' lists");
            element.nodes[k] = found->second;
          }
        if (element.n == 1u << dim)
          mesh.cells.push_back(element);
        else if (element.n == 1u << (dim - 1))
          mesh.sides.push_back(element);
      }


      Words                                 words;
      const unsigned int                    dim;
      bool                                  is_old = false, is_latest = false;
      bool                                  has_entities = false, partitioned = false;
      std::map<std::pair<int, int>, int>    ids; // physical, of entities (dimension, number)
      std::unordered_map<int, unsigned int> index_of, elements; // of node numbers; their lines
      MshMesh                               mesh;
    };
  } // namespace


  MshMesh parse_msh(const std::string &text, const std::string &name, const unsigned int dim)
  {
    return Parser(text, name, dim).parse();
  }
} // namespace PeriDeal
