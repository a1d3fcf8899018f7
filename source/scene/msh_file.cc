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


    struct ElementType
    {
      const char  *name;
      unsigned int dimension, n_nodes;
    };

    /** By Gmsh's numbers. */
    const std::map<int, ElementType> element_types{{1, {"line", 1, 2}},
                                                   {2, {"triangle", 2, 3}},
                                                   {3, {"quadrilateral", 2, 4}},
                                                   {4, {"tetrahedron", 3, 4}},
                                                   {5, {"hexahedron", 3, 8}},
                                                   {6, {"prism", 3, 6}},
                                                   {7, {"pyramid", 3, 5}},
                                                   {15, {"point", 0, 1}}};


    /**
     * The words of a file, with their lines; comments between its sections are passed over. Numbers
     * of a binary file count as words too, on the lines of the same file as text.
     */
    class Words
    {
    public:
      Words(const std::string &text, const std::string &name)
        : text(text)
        , file(name)
        , name(name)
      {}

      /** The next word; at the end of the file an error that says what is missing. */
      std::string_view next(const std::string &expected)
      {
        const std::string_view word = any(expected);
        if (word != "$Comments")
          return word;
        while (any("'$EndComments'") != "$EndComments")
          {}
        return next(expected);
      }

      /** The word that comes next, comments like anything else; none at the end of the file. */
      std::string_view coming() const
      {
        const std::size_t begin = std::min(text.find_first_not_of(blanks, position), text.size());
        return std::string_view(text).substr(begin, text.find_first_of(blanks, begin) - begin);
      }

      double real(const std::string &what)
      {
        const std::string           word  = number<double>(what);
        const std::optional<double> value = plain_number(word);
        if (!value)
          broken("found '" + shortened(word) + "'", what);
        if (!(std::abs(*value) < 1e100)) // squares and products have to be finite, too
          broken("found " + shortened(word) + ", which is too large", what);
        return *value;
      }

      int whole(const std::string &what, const long lowest, const long highest)
      {
        return whole(number<std::int32_t>(what), what, lowest, highest);
      }

      /** The number of a node or an element, for which version 4.1 has 8 bytes. */
      int tag(const std::string &what, const long lowest)
      {
        return whole(has_wide_numbers ? number<std::uint64_t>(what) : number<std::int32_t>(what),
                     what,
                     lowest,
                     largest);
      }

      /** A number of things that follow, of which each takes two letters or 4 bytes at least. */
      int count(const std::string &what)
      {
        const std::string word = has_wide_numbers || !given.empty() ? number<std::uint64_t>(what) :
                                                                      std::string(next(what));
        const std::size_t rest = text.size() - position;
        if (has_bytes && has_wide_numbers && std::stoull(word) > rest / 4)
          error_of_binary("the file is broken: it counts " + word +
                          " things that it does not have.");
        const int n = whole(word, what, 0, largest);
        if (!has_bytes && static_cast<std::size_t>(n) > rest / 2 + 1)
          broken("found " + std::to_string(n) + ", more than the rest of the file can hold", what);
        return n;
      }

      void skip_to(const std::string &end)
      {
        while (next("'" + end + "'") != end)
          {}
      }

      /** What stands before the word, with its line ends; behind the word goes on what follows. */
      std::string text_until(const std::string &end)
      {
        const std::size_t begin = position;
        skip_to(end);
        return text.substr(begin, position - end.size() - begin);
      }

      void require(const std::string &expected)
      {
        const std::string word(next("'" + expected + "'"));
        if (word != expected)
          broken("found '" + shortened(word) + "'", "'" + expected + "'");
      }

      /** The rest of the header of a binary file, which has this version. */
      void begin_binary(const std::string &version, const bool latest)
      {
        next("the kind of the file");
        if ((!latest && version.substr(0, 2) != "2." && version != "2") || coming() != "8")
          error_of_binary("it is binary and of version " + version +
                          ", of which binary files are not read. Save it as text (in Gmsh: without "
                          "-bin, Mesh.Binary = 0), or as version 4.1.");
        has_bytes        = true;
        has_wide_numbers = latest;
        name             = file + " (binary, as text)";
        begin_data();
        if (read<std::int32_t>() != 1)
          error_of_binary("it is binary and has the byte order of another kind of machine. Save it "
                          "as text (in Gmsh: without -bin, Mesh.Binary = 0).");
        --line; // as text, that number is not there
        end_line();
      }

      /** In a binary file there are numbers from the next line on. */
      void begin_data()
      {
        if (has_bytes)
          position = std::min(text.find('\n', position), text.size() - 1) + 1;
        end_line();
      }

      /** As text, the numbers that follow stand on the next line. */
      void end_line()
      {
        n_ended += has_bytes ? 1 : 0;
      }

      /** As skip_to() the end of a section that may have numbers. */
      void skip_section(const std::string &title)
      {
        const std::string end = "$End" + title.substr(1);
        if (!has_bytes)
          return skip_to(end);
        const std::size_t found = text.find(end, position);
        if (found == std::string::npos)
          error_of_binary("the file is broken: it ends within " + title + ".");
        position = found + end.size();
        ++line;
      }

      /** Begin the next element of a binary file of version 2, of which @p n_left are left: the
       * words that its block has for all of its elements come behind its number. */
      void begin_element(const int n_left)
      {
        if (n_of_block == 0)
          {
            type       = read<std::int32_t>();
            n_of_block = read<std::int32_t>();
            n_tags     = read<std::int32_t>();
            if (n_of_block < 1 || n_of_block > n_left || n_tags < 0)
              error_of_binary("the file is broken: a block of " + std::to_string(n_of_block) +
                              " elements, " + std::to_string(n_left) + " are left.");
          }
        --n_of_block;
        given = {number<std::int32_t>(""), std::to_string(type), std::to_string(n_tags)};
      }

      [[noreturn]] void broken(const std::string &found, const std::string &expected) const
      {
        error("the file is broken: " + found + ", expected " + expected + ".");
      }

      [[noreturn]] void error(const std::string &what) const
      {
        msh_error(name, line, what);
      }

      unsigned int line_number() const
      {
        return line;
      }

      bool is_binary() const
      {
        return has_bytes;
      }

      static constexpr long largest = 2147483646;

    private:
      int whole(const std::string &word,
                const std::string &what,
                const long         lowest,
                const long         highest) const
      {
        const bool digits = word.size() < 12 &&
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

      /** As next(), comments like anything else. */
      std::string_view any(const std::string &expected)
      {
        const std::string_view word = coming();
        line += n_ended > 0 ? n_ended : std::count(text.data() + position, word.data(), '\n');
        n_ended  = 0;
        position = word.data() + word.size() - text.data();
        if (word.empty() && has_bytes)
          error_of_binary("the file is broken: it ends before '$Elements'.");
        if (word.empty())
          broken("the file ends", expected);
        return word;
      }

      /** The next number, of which a binary file has the bytes. */
      template <typename T>
      std::string number(const std::string &what)
      {
        if (!given.empty())
          {
            const std::string word = given.front();
            given.erase(given.begin());
            return word;
          }
        if (!has_bytes)
          return std::string(next(what));
        std::ostringstream word;
        word << std::setprecision(17) << read<T>();
        return word.str();
      }

      template <typename T>
      T read()
      {
        if (position + sizeof(T) > text.size())
          error_of_binary("the file is broken: it ends within its binary numbers.");
        T value;
        std::memcpy(&value, text.data() + position, sizeof(T));
        position += sizeof(T);
        line += n_ended;
        n_ended = 0;
        return value;
      }

      /** In the line that says that the file is binary. */
      [[noreturn]] void error_of_binary(const std::string &what) const
      {
        msh_error(file, 2, what);
      }

      static std::string shortened(const std::string &word)
      {
        std::string result = word.size() > 40 ? word.substr(0, 40) + "..." : word;
        for (char &c : result) // of a file that is no text
          if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || static_cast<signed char>(c) < 0)
            c = '?';
        return result;
      }

      static constexpr const char *blanks = " \t\n\v\f\r";

      const std::string       &text, &file;
      std::string              name; // in messages
      std::size_t              position = 0;
      unsigned int             line = 1, n_ended = 0;
      bool                     has_bytes = false, has_wide_numbers = false;
      int                      type = 0, n_of_block = 0, n_tags = 0; // of elements, version 2
      std::vector<std::string> given;                                // words that come first
    };


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
        is_old    = two.count(version) > 0;
        is_latest = version == "4.1";
        if (words.coming() == "1")
          words.begin_binary(version, is_latest);
        if (two.count(version) == 0 && four.count(version) == 0 && version != "4.1")
          words.error("found version '" + version.substr(0, 40) + "' of the format." + supported);
        if (!words.is_binary())
          {
            const int kind = words.whole("the kind of the file, 0 (text)", 0, Words::largest);
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
              same[{dimension, id}] = found->second;
          }
      }


      void read_entities()
      {
        if (is_old)
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
              words.end_line();
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
        words.end_line();
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
        return words.tag("the number of a node", 1);
      }


      void read_nodes()
      {
        if (is_latest)
          words.begin_data();
        const int n_blocks = is_old ? 1 : words.count("the number of blocks of nodes");
        const int n_nodes  = words.count("the number of nodes");
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
                words.end_line();
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
                  {
                    number = node_number();
                    words.end_line();
                  }
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
        if (is_latest)
          {
            words.tag("the smallest number of a " + what, 0);
            words.tag("the largest number of a " + what, 0);
            words.end_line();
          }
        else if (is_old)
          words.begin_data();
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
        if (is_latest)
          words.begin_data();
        const int n_blocks   = is_old ? 1 : words.count("the number of blocks of elements");
        const int n_elements = words.count("the number of elements");
        read_range("element");
        int n_read = 0;
        for (int block = 0; block < n_blocks; ++block)
          {
            int  n = n_elements, id = 0, type = 0;
            auto more = more_groups.end(); // of a point
            if (!is_old)
              {
                const auto entity       = read_entity();
                type                    = read_type();
                const ElementType &kind = element_types.at(type);
                if (static_cast<int>(kind.dimension) != entity.first)
                  words.broken("found a " + std::string(kind.name) + " in an entity of dimension " +
                                 std::to_string(entity.first),
                               "an element of that dimension");
                const auto found = ids.find(entity);
                if (found == ids.end() && has_entities && !partitioned)
                  words.broken("found entity " + std::to_string(entity.second) + " of dimension " +
                                 std::to_string(entity.first),
                               "one that '$Entities' lists");
                id   = found == ids.end() ? 0 : found->second;
                more = type == 15 ? more_groups.find(entity.second) : more_groups.end();
                n    = words.count("the number of elements in this block");
                words.end_line();
                if (n > n_elements - n_read)
                  words.broken("found " + std::to_string(n) + " elements in this block",
                               "no more than " + std::to_string(n_elements) +
                                 " in all, as '$Elements' says");
              }
            for (int i = 0; i < n; ++i)
              {
                if (is_old && words.is_binary())
                  words.begin_element(n - i);
                read_element(type, id);
              }
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
        const int  type  = words.whole("the type of an element", 1, 1000);
        const auto found = element_types.find(type);
        if (found == element_types.end())
          words.error("found an element of type " + std::to_string(type) +
                      ", which is of higher order or none of Gmsh's." + supported);
        const auto &[name, dimension, n_nodes] = found->second;
        if (n_nodes != 1u << dimension || dimension > dim)
          words.error("found a " + std::string(name) + ", which a mesh of dimension " +
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
        element.number = words.tag("the number of an element", 0);
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
        element.id = the_first_of(element_types.at(type).dimension, id);
        element.n  = element_types.at(type).n_nodes;
        for (unsigned int k = 0; k < element.n; ++k)
          {
            const int  number = words.tag("a node of element " + std::to_string(element.number), 1);
            const auto found  = index_of.find(number);
            if (found == index_of.end())
              words.broken("found node " + std::to_string(number) + " in element " +
                             std::to_string(element.number),
                           "one that '$Nodes' lists");
            element.nodes[k] = found->second;
          }
        words.end_line();
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
