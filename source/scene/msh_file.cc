// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

#include "msh_words.h"

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
      " PeriDeal reads Gmsh files (.msh) of the versions 2.2, 4.0 and 4.1.";


    struct ElementType
    {
      unsigned int dimension, n_nodes, n_corners;
    };

    /** By Gmsh's numbers. */
    const std::map<int, ElementType> element_types{
      {1, {1, 2, 2}},   {2, {2, 3, 3}},   {3, {2, 4, 4}},   {4, {3, 4, 4}},   {5, {3, 8, 8}},
      {6, {3, 6, 6}},   {7, {3, 5, 5}},   {8, {1, 3, 2}},   {9, {2, 6, 3}},   {10, {2, 9, 4}},
      {11, {3, 10, 4}}, {12, {3, 27, 8}}, {13, {3, 18, 6}}, {14, {3, 14, 5}}, {15, {0, 1, 1}},
      {16, {2, 8, 4}},  {17, {3, 20, 8}}, {18, {3, 15, 6}}, {19, {3, 13, 5}}, {20, {2, 9, 3}},
      {21, {2, 10, 3}}, {26, {1, 4, 2}},  {27, {1, 5, 2}},  {29, {3, 20, 4}}, {36, {2, 16, 4}},
      {92, {3, 64, 8}}};


    class Parser
    {
    public:
      Parser(const std::string &text, const std::string &name, const unsigned int dim)
        : words(text, name)
        , file_name(name)
        , dim(dim)
      {}

      MshMesh parse()
      {
        mesh.dim = dim;
        read_header();
        std::string section(words.next("'$Nodes'"));
        for (;; section = words.next("'$Nodes'"))
          if (section == "$PhysicalNames")
            read_names();
          else if (section == "$Entities")
            read_entities();
          else if (section == "$PartitionedEntities")
            {
              head.partitioned = true;
              words.skip_section(section);
            }
          else
            break;
        if (section != "$Nodes")
          words.broken("found '" + section.substr(0, 40) + "'", "'$Nodes'");
        read_nodes();
        words.require("$EndNodes");
        words.require("$Elements");
        read_elements();
        if (!words.is_binary() || words.coming() == "$EndElements")
          words.require("$EndElements");
        if (mesh.cells.empty())
          no_cells();
        if (head.n_curved > 0)
          mesh.notes.push_back(
            "of " + std::to_string(head.n_curved) +
            " cells of higher order the corners are taken, with straight edges between them.");
        forget_twins();
        forget_unused_points();
        return std::move(mesh);
      }

    private:
      [[noreturn]] void no_cells() const
      {
        const std::string expected = dim == 3 ? "hexahedra, tetrahedra or wedges" :
                                     dim == 2 ? "quadrilaterals or triangles" :
                                                "lines";
        AssertThrow(false,
                    NoCells("'Mesh file' in section 'Domain': '" + file_name + "', line " +
                            std::to_string(words.line_number()) + ": the file has no " + expected +
                            ", of which a mesh of dimension " + std::to_string(dim) +
                            " consists: its elements are " +
                            (kinds.empty() ? "none" : join_names(kinds)) + "."));
        std::abort(); // not reached
      }


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
        head.is_old    = two.count(version) > 0;
        head.is_latest = version == "4.1";
        if (two.count(version) == 0 && four.count(version) == 0 && version != "4.1")
          words.error("found version '" + version.substr(0, 40) + "' of the format." + supported);
        if (words.coming() == "1")
          words.begin_binary(version, head.is_latest);
        if (!words.is_binary())
          {
            const int kind = words.whole("the kind of the file, 0 (text)", 0, MshWords::largest);
            if (kind != 0)
              words.error("the kind of the file is " + std::to_string(kind) +
                          ", neither text (0) nor binary (1): it is broken.");
            words.whole("the size of a number, 8 bytes", 8, 8);
          }
        words.require("$EndMeshFormat");
      }


      /** Groups of a dimension that have one name have the first one's number. */
      void read_names()
      {
        std::istringstream lines(words.text_until("$EndPhysicalNames"));
        for (std::string line; std::getline(lines, line);)
          {
            std::istringstream numbers(line);
            unsigned int       dimension = 0;
            int                id        = -1;
            const std::size_t  from = line.find('"'), to = line.rfind('"');
            if (!(numbers >> dimension >> id) || id < 0 || from >= to)
              continue;
            const std::string name = trimmed(line.substr(from + 1, to - from - 1));
            if (name.empty())
              continue;
            const auto found = mesh.ids.emplace(std::make_pair(dimension, name), id).first;
            if (found->second != id)
              groups.same[{dimension, id}] = found->second;
          }
      }


      void read_entities()
      {
        if (head.is_old)
          words.broken("found '$Entities', which version 2 does not have", "'$Nodes'");
        words.begin_data();
        std::array<int, 4> n;
        for (unsigned int d = 0; d < 4; ++d)
          n[d] = words.count("the number of entities of dimension " + std::to_string(d));
        words.end_line();
        for (unsigned int d = 0; d < 4; ++d)
          for (int i = 0; i < n[d]; ++i)
            {
              const std::string what =
                "entity " + std::to_string(i + 1) + " of dimension " + std::to_string(d);
              const int tag =
                words.whole("the number of " + what, -MshWords::largest, MshWords::largest);
              for (unsigned int k = 0; k < (d == 0 && head.is_latest ? 3 : 6); ++k)
                words.real("a coordinate of " + what);
              const int        n_physical = words.count("the number of physical groups of " + what);
              std::vector<int> own;
              for (int k = 0; k < n_physical; ++k)
                {
                  const int one = words.whole("the physical group of " + what,
                                              -MshWords::largest,
                                              MshWords::largest);
                  // Negative of a curve that is turned around.
                  own.push_back(the_first_of(d, std::abs(one)));
                }
              if (d > 0)
                {
                  const int n_around = words.count("the number of entities around " + what);
                  for (int k = 0; k < n_around; ++k)
                    words.whole("an entity around " + what, -MshWords::largest, MshWords::largest);
                }
              words.end_line();
              if (!groups.all.insert({{static_cast<int>(d), tag}, own}).second)
                words.broken("found number " + std::to_string(tag) + " twice",
                             "each entity of dimension " + std::to_string(d) + " once");
            }
        words.require("$EndEntities");
        head.has_entities = true;
        choose_groups();
      }


      /** Of the groups of an entity the one with the fewest entities, so that the parts of a body
       * count more than the whole; points have all. */
      void choose_groups()
      {
        std::map<std::pair<int, int>, unsigned int> sizes;
        for (const auto &[entity, own] : groups.all)
          for (const int group : own)
            ++sizes[{entity.first, group}];
        for (const auto &[entity, own] : groups.all)
          {
            int &id = groups.chosen[entity];
            for (const int group : own)
              if (id == 0 || sizes[{entity.first, group}] < sizes[{entity.first, id}])
                id = group;
            for (const int group : own)
              if (group != id && (entity.first == static_cast<int>(dim) ||
                                  entity.first + 1 == static_cast<int>(dim)))
                mesh.notes.push_back("entity " + std::to_string(entity.second) + " of dimension " +
                                     std::to_string(entity.first) + " is in the physical groups " +
                                     group_name(entity.first, id) + " and " +
                                     group_name(entity.first, group) +
                                     ": it counts for the first, which has fewer of them.");
          }
      }


      /** The place of a node; one that is given once more has to be at the same one. */
      unsigned int read_point(const int number, const int n_parameters)
      {
        std::array<double, 3> p;
        for (unsigned int d = 0; d < 3; ++d)
          p[d] = words.real(std::string(1, "xyz"[d]) + " of node " + std::to_string(number));
        for (int k = 0; k < n_parameters; ++k)
          words.real("a parameter of node " + std::to_string(number));
        words.end_line();
        ++head.n_points;
        const auto [entry, is_new] = index_of.insert({number, mesh.points.size()});
        if (!is_new && mesh.points[entry->second] != p)
          again.push_back({entry->second, words.line_number(), p});
        if (is_new)
          {
            mesh.points.push_back(p);
            mesh.numbers.push_back(number);
          }
        return entry->second;
      }


      /** Nodes that are given once more: at the same place, but for round-off. */
      void check_again()
      {
        constexpr double round_off = 1e-9; // of the extent
        double           extent    = 0.;
        for (const auto &p : mesh.points)
          for (unsigned int d = 0; d < 3; ++d)
            extent = std::max(extent, std::abs(p[d] - mesh.points[0][d]));
        for (const Again &node : again)
          for (unsigned int d = 0; d < 3; ++d)
            if (std::abs(mesh.points[node.index][d] - node.place[d]) > round_off * extent)
              words.broken("found node " + std::to_string(mesh.numbers[node.index]) +
                             " twice, at different places",
                           "each number once",
                           node.line);
      }


      /** A node of a point entity is in its groups, though there may be no element that says so. */
      template <typename Iterator>
      void add_place(const unsigned int node, const Iterator own)
      {
        if (dim == 1 || own == groups.all.end())
          return;
        for (const int id : own->second)
          {
            MshElement place;
            place.n        = 1;
            place.id       = id;
            place.nodes[0] = node;
            mesh.places.push_back(place);
          }
      }


      int node_number()
      {
        return words.tag("the number of a node", 1);
      }


      void read_nodes()
      {
        if (!head.is_old)
          words.begin_data();
        const int n_blocks = head.is_old ? 1 : words.count("the number of blocks of nodes");
        const int n_nodes  = words.count("the number of nodes");
        read_range("node");
        for (int block = 0; block < n_blocks; ++block)
          {
            int  n = n_nodes, n_parameters = 0;
            auto own = groups.all.end(); // of a point
            if (!head.is_old)
              {
                const auto entity = read_entity();
                n_parameters =
                  words.whole("whether nodes have parameters, 0 or 1", 0, 1) * entity.first;
                own = entity.first == 0 ? groups.all.find(entity) : own;
                n   = words.count("the number of nodes in this block");
                words.end_line();
                if (n > n_nodes - head.n_points)
                  words.broken("found " + std::to_string(n) + " nodes in this block",
                               "no more than " + std::to_string(n_nodes) +
                                 " in all, as '$Nodes' says");
              }
            if (head.is_latest)
              {
                // all numbers come first
                std::vector<int> numbers(n);
                for (int &number : numbers)
                  {
                    number = node_number();
                    words.end_line();
                  }
                for (const int number : numbers)
                  add_place(read_point(number, n_parameters), own);
              }
            else
              for (int i = 0; i < n; ++i)
                {
                  const int number = node_number();
                  add_place(read_point(number, n_parameters), own);
                }
          }
        if (head.n_points != n_nodes)
          words.broken("found " + std::to_string(head.n_points) + " nodes in all blocks",
                       std::to_string(n_nodes) + ", as '$Nodes' says");
        check_again();
      }


      void read_range(const std::string &what)
      {
        if (head.is_latest)
          {
            words.tag("the smallest number of a " + what, 0);
            words.tag("the largest number of a " + what, 0);
            words.end_line();
          }
        else if (head.is_old)
          words.begin_data();
      }


      /** Dimension and number of the entity of a block. */
      std::pair<int, int> read_entity()
      {
        int dimension = 0, tag = 0;
        for (const bool is_dimension : {head.is_latest, !head.is_latest})
          if (is_dimension)
            dimension = words.whole("the dimension of an entity", 0, 3);
          else
            tag = words.whole("the number of an entity", -MshWords::largest, MshWords::largest);
        return {dimension, tag};
      }


      /** Elements of one kind, in version 4 of one entity. */
      struct Block
      {
        int n, id = 0, type = 0, entity = 0;
      };

      /**
       * The head of a block, which version 2 has not. @param n_left elements that are still to come
       */
      Block read_block(const int n_left)
      {
        Block block{n_left};
        if (head.is_old)
          return block;
        const auto entity       = read_entity();
        block.type              = read_type();
        block.entity            = entity.second;
        const ElementType &kind = element_types.at(block.type);
        if (static_cast<int>(kind.dimension) != entity.first)
          words.broken("found a " + name_of(kind) + " in an entity of dimension " +
                         std::to_string(entity.first),
                       "an element of that dimension");
        const auto found = groups.chosen.find(entity);
        if (found == groups.chosen.end() && head.has_entities && !head.partitioned)
          words.broken("found entity " + std::to_string(entity.second) + " of dimension " +
                         std::to_string(entity.first),
                       "one that '$Entities' lists");
        block.id = found == groups.chosen.end() ? 0 : found->second;
        block.n  = words.count("the number of elements in this block");
        words.end_line();
        if (block.n > n_left)
          words.broken("found " + std::to_string(block.n) + " elements in this block",
                       "no more than " + std::to_string(head.n_elements) +
                         " in all, as '$Elements' says");
        return block;
      }


      void read_elements()
      {
        if (!head.is_old)
          words.begin_data();
        const int n_blocks = head.is_old ? 1 : words.count("the number of blocks of elements");
        head.n_elements    = words.count("the number of elements");
        read_range("element");
        int n_read = 0;
        for (int b = 0; b < n_blocks; ++b)
          {
            const Block block = read_block(head.n_elements - n_read);
            for (int i = 0; i < block.n; ++i)
              {
                if (head.is_old && words.is_binary())
                  words.begin_element(block.n - i);
                read_element(block.type, block.id);
              }
            if (!head.is_old && block.type == 15 && !mesh.places.empty())
              add_place(mesh.places.back().nodes[0], groups.all.find({0, block.entity}));
            n_read += block.n;
          }
        if (n_read != head.n_elements)
          words.broken("found " + std::to_string(n_read) + " elements in all blocks",
                       std::to_string(head.n_elements) + ", as '$Elements' says");
      }


      static std::string name_of(const ElementType &type)
      {
        return msh_shape(type.dimension, type.n_corners);
      }


      /** A type that a mesh of this dimension can have. */
      int read_type()
      {
        const int  type  = words.whole("the type of an element", 1, 1000);
        const auto entry = element_types.find(type);
        if (entry == element_types.end())
          words.error(
            "found an element of type " + std::to_string(type) +
            ", which PeriDeal does not know. It takes points, lines, triangles, "
            "quadrilaterals, tetrahedra, wedges and hexahedra of the first and second order.");
        const ElementType &kind = entry->second;
        if (kind.dimension > dim)
          words.error("found a " + name_of(kind) + ", which a mesh of dimension " +
                      std::to_string(dim) +
                      " does not have: use 'Dimension = " + std::to_string(kind.dimension) +
                      "', or save the elements of dimension " + std::to_string(dim) + " only.");
        if (kind.n_corners == 5 && kind.dimension == 3)
          words.error(
            "found a pyramid: it cannot be divided into hexahedra that fit those of its neighbours, "
            "as tetrahedra, wedges and hexahedra can. Mesh the volume without pyramids (in Gmsh: all "
            "tetrahedra, or hexahedra and wedges that are extruded).");
        kinds.insert(name_of(kind));
        return type;
      }


      /** Places that an element and an entity name. */
      void forget_twins()
      {
        std::set<std::pair<unsigned int, int>> known;
        std::vector<MshElement>                places;
        for (const MshElement &place : mesh.places)
          if (place.id != 0 && known.insert({place.nodes[0], place.id}).second)
            places.push_back(place);
        mesh.places.swap(places);
      }


      /** Those that no corner of an element has: of elements of higher order, and of geometry. */
      void forget_unused_points()
      {
        constexpr unsigned int    none = static_cast<unsigned int>(-1);
        std::vector<unsigned int> number(mesh.points.size(), none);
        for (auto *const list : {&mesh.cells, &mesh.sides, &mesh.places})
          for (const MshElement &element : *list)
            for (unsigned int k = 0; k < element.n; ++k)
              number[element.nodes[k]] = 0;
        unsigned int n = 0;
        for (std::size_t i = 0; i < number.size(); ++i)
          if (number[i] == 0)
            {
              mesh.points[n]  = mesh.points[i];
              mesh.numbers[n] = mesh.numbers[i];
              number[i]       = n++;
            }
        mesh.points.resize(n);
        mesh.numbers.resize(n);
        for (auto *const list : {&mesh.cells, &mesh.sides, &mesh.places})
          for (MshElement &element : *list)
            for (unsigned int k = 0; k < element.n; ++k)
              element.nodes[k] = number[element.nodes[k]];
      }


      /** The group whose name this one has, too. */
      int the_first_of(const unsigned int dimension, const int id) const
      {
        const auto other = groups.same.find({dimension, id});
        return other == groups.same.end() ? id : other->second;
      }


      /** "'steel' (3)" */
      std::string group_name(const unsigned int dimension, const int id) const
      {
        for (const auto &[key, number] : mesh.ids)
          if (key.first == dimension && number == id)
            return "'" + key.second + "' (" + std::to_string(id) + ")";
        return std::to_string(id);
      }


      /** @param type,id of its block; with version 2 they stand with the element */
      void read_element(int type, int id)
      {
        MshElement element;
        element.number = words.tag("the number of an element", 0);
        element.line   = words.line_number();
        if (!elements.insert({element.number, element.line}).second)
          words.broken("found element " + std::to_string(element.number) +
                         " for the second time, first in line " +
                         std::to_string(elements.at(element.number)),
                       "each number once");
        if (head.is_old)
          {
            type             = read_type();
            const int n_tags = words.count("the number of tags of an element");
            id               = 0;
            for (int k = 0; k < n_tags; ++k)
              {
                // partitions may be negative, the first tag is the physical group
                const int tag = words.whole("a tag of element " + std::to_string(element.number),
                                            k == 0 ? 0 : -MshWords::largest,
                                            MshWords::largest);
                id            = k == 0 ? tag : id;
              }
          }
        const auto [dimension, n_nodes, n_corners] = element_types.at(type);
        element.id                                 = the_first_of(dimension, id);
        element.n                                  = n_corners;
        for (unsigned int k = 0; k < n_nodes; ++k)
          {
            const int  number = words.tag("a node of element " + std::to_string(element.number), 1);
            const auto entry  = index_of.find(number);
            if (entry == index_of.end())
              words.broken("found node " + std::to_string(number) + " in element " +
                             std::to_string(element.number),
                           "one that '$Nodes' lists");
            if (k < n_corners)
              element.nodes[k] = entry->second;
          }
        words.end_line();
        if (dimension == dim)
          {
            mesh.cells.push_back(element);
            head.n_curved += n_nodes > n_corners ? 1 : 0;
          }
        else if (dimension + 1 == dim)
          mesh.sides.push_back(element);
        else if (dimension == 0)
          mesh.places.push_back(element);
      }


      /** A node that is given once more, at another place. */
      struct Again
      {
        unsigned int          index, line;
        std::array<double, 3> place;
      };

      /** What is known of the file. */
      struct Head
      {
        bool is_old = false, is_latest = false, has_entities = false, partitioned = false;
        int  n_elements = 0, n_points = 0, n_curved = 0; // nodes as often as they are given
      };

      /** Groups that entities, by dimension and number, are in, and that which counts of each; the
       * first of the groups that share a dimension and a name. */
      struct Groups
      {
        std::map<std::pair<int, int>, std::vector<int>> all;
        std::map<std::pair<int, int>, int>              chosen;
        std::map<std::pair<unsigned int, int>, int>     same;
      };

      MshWords                              words;
      const std::string                    &file_name;
      const unsigned int                    dim;
      Head                                  head;
      Groups                                groups;
      std::unordered_map<int, unsigned int> index_of, elements; // of node numbers; their lines
      std::vector<Again>                    again;
      std::set<std::string>                 kinds; // of elements
      MshMesh                               mesh;
    };
  } // namespace


  MshMesh parse_msh(const std::string &text, const std::string &name, const unsigned int dim)
  {
    return Parser(text, name, dim).parse();
  }
} // namespace PeriDeal
