// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
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
      " PeriDeal reads Gmsh files (.msh, versions 2.2 and 4.1) of quadrilaterals in 2D and hexahedra in 3D only "
      "(in Gmsh: 'Recombine Surface' and Mesh.SubdivisionAlgorithm = 1 make quadrilaterals, = 2 hexahedra; or use transfinite or extruded volumes).";


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


    unsigned int type_dimension(const int type)
    {
      return type == 15 ? 0 : type == 1 ? 1 : type < 4 ? 2 : 3;
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
        for (;; section = words.next("'$Nodes'"))
          if (section == "$PhysicalNames")
            read_names();
          else if (section == "$Entities")
            read_entities();
          else if (section == "$PartitionedEntities")
            {
              partitioned = true;
              words.skip_to("$EndPartitionedEntities");
            }
          else
            break;
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
          words.error("the kind of the file is " + std::to_string(kind) +
                      ", neither text (0) nor binary (1): it is broken.");
        words.whole("the size of a number, 8 bytes", 8, 8);
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
              same[{dimension, id}] = found->second;
          }
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
              int       id         = 0;
              for (int k = 0; k < n_physical; ++k)
                {
                  const int one =
                    words.whole("the physical group of " + what, -Words::largest, Words::largest);
                  // Negative of a curve that is turned around.
                  const int group = the_first_of(d, std::abs(one));
                  if (k == 0)
                    id = group;
                  else if (d == 0)
                    more_groups[tag].push_back(group);
                  else if (group != id && (d == dim || d + 1 == dim))
                    words.error(what + " is in the physical groups " + group_name(d, id) + " and " +
                                group_name(d, group) +
                                ", where one is allowed: make one group of it, or divide it.");
                }
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


      /** The place of a node; one that is given once more has to be at the same one. */
      void read_point(const int number)
      {
        std::array<double, 3> p;
        for (unsigned int d = 0; d < 3; ++d)
          p[d] = words.real(std::string(1, "xyz"[d]) + " of node " + std::to_string(number));
        ++n_points;
        const auto [entry, is_new] = index_of.insert({number, mesh.points.size()});
        if (!is_new && mesh.points[entry->second] != p)
          words.broken("found node " + std::to_string(number) + " twice, at different places",
                       "each number once");
        if (!is_new)
          return;
        mesh.points.push_back(p);
        mesh.numbers.push_back(number);
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
                if (n > n_nodes - n_points)
                  words.broken("found " + std::to_string(n) + " nodes in this block",
                               "no more than " + std::to_string(n_nodes) +
                                 " in all, as '$Nodes' says");
              }
            if (is_latest)
              {
                // all numbers come first
                std::vector<int> numbers(n);
                for (int &number : numbers)
                  number = node_number();
                for (const int number : numbers)
                  read_point(number);
              }
            else
              for (int i = 0; i < n; ++i)
                read_point(node_number());
          }
        if (n_points != n_nodes)
          words.broken("found " + std::to_string(n_points) + " nodes in all blocks",
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
            int  n = n_elements, id = 0, type = 0;
            auto more = more_groups.end(); // of a point
            if (!is_old)
              {
                const auto entity = read_entity();
                type              = read_type();
                const int of_type = type_dimension(type);
                if (of_type != entity.first)
                  words.broken("found a " + std::string(type_name(type)) +
                                 " in an entity of dimension " + std::to_string(entity.first),
                               "an element of that dimension");
                const auto found = ids.find(entity);
                if (found == ids.end() && has_entities && !partitioned)
                  words.broken("found entity " + std::to_string(entity.second) + " of dimension " +
                                 std::to_string(entity.first),
                               "one that '$Entities' lists");
                id   = found == ids.end() ? 0 : found->second;
                more = type == 15 ? more_groups.find(entity.second) : more_groups.end();
                n    = words.count("the number of elements in this block");
                if (n > n_elements - n_read)
                  words.broken("found " + std::to_string(n) + " elements in this block",
                               "no more than " + std::to_string(n_elements) +
                                 " in all, as '$Elements' says");
              }
            for (int i = 0; i < n; ++i)
              read_element(type, id);
            if (more != more_groups.end() && dim > 1 && n > 0)
              for (const int other : more->second)
                {
                  mesh.places.push_back(mesh.places.back());
                  mesh.places.back().id = other;
                }
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


      /** The group whose name this one has, too. */
      int the_first_of(const unsigned int dimension, const int id) const
      {
        const auto other = same.find({dimension, id});
        return other == same.end() ? id : other->second;
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
        element.id = the_first_of(type_dimension(type), id);
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
        else if (element.n == 1)
          mesh.places.push_back(element);
      }


      Words                              words;
      const unsigned int                 dim;
      bool                               is_old = false, is_latest = false;
      bool                               has_entities = false, partitioned = false;
      int                                n_points = 0; // as often as they are given
      std::map<std::pair<int, int>, int> ids;          // physical, of entities (dimension, number)
      std::map<int, std::vector<int>>    more_groups;  // of points, beside the first
      std::map<std::pair<unsigned int, int>, int>
        same; // first of the groups that share a dimension and a name
      std::unordered_map<int, unsigned int> index_of, elements; // of node numbers; their lines
      MshMesh                               mesh;
    };
  } // namespace


  std::string text_of_msh(const MshMesh &mesh, const unsigned int dim)
  {
    std::ostringstream text;
    text << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
         << mesh.points.size() << "\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      text << i + 1 << " " << mesh.points[i][0] << " " << mesh.points[i][1] << " "
           << mesh.points[i][2] << "\n";
    text << "$EndNodes\n$Elements\n" << mesh.sides.size() + mesh.cells.size() << "\n";
    constexpr int types[4] = {15, 1, 3, 5};
    std::size_t   number   = 0;
    for (const auto *const list : {&mesh.sides, &mesh.cells})
      for (const MshElement &element : *list)
        {
          text << ++number << " " << types[list == &mesh.cells ? dim : dim - 1] << " 2 "
               << element.id << " " << element.id;
          for (unsigned int k = 0; k < element.n; ++k)
            text << " " << element.nodes[k] + 1;
          text << "\n";
        }
    text << "$EndElements\n";
    return text.str();
  }


  MshMesh parse_msh(const std::string &text, const std::string &name, const unsigned int dim)
  {
    if (const std::string converted = text_of_binary_msh(text, name); !converted.empty())
      return Parser(converted, name + " (binary, as text)", dim).parse();
    return Parser(text, name, dim).parse();
  }


  MshMesh read_msh(const std::string &file_name, const std::string &folder, const unsigned int dim)
  {
    std::string     path = file_name, fault;
    std::error_code error;
    if (const auto beside = std::filesystem::path(folder) / file_name;
        !std::filesystem::exists(path, error) && std::filesystem::exists(beside, error))
      path = beside.string();
    const std::string text = read_file(path, most_bytes_of_data, fault);
    AssertThrow(fault.empty(),
                UserError("'Mesh file' in section 'Domain': '" + file_name + "' " + fault +
                          places_looked_at(file_name, folder)));
    MshMesh mesh = parse_msh(text, file_name, dim);
    check_msh(mesh, file_name, dim);
    return mesh;
  }
} // namespace PeriDeal
