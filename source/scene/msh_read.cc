// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/external_program.h>
#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "msh_shapes.h"

namespace PeriDeal
{
  namespace fs = std::filesystem;

  namespace
  {
    [[noreturn]] void refuse_file(const std::string &file_name, const std::string &what)
    {
      AssertThrow(false, UserError("'Mesh file' in section 'Domain': '" + file_name + "' " + what));
      std::abort(); // not reached
    }


    bool is_gmsh(const std::string &text, const std::string &path)
    {
      std::string extension = fs::path(path).extension().string();
      for (char &letter : extension)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      return extension == ".msh" || text.compare(0, 11, "$MeshFormat") == 0 || text.empty();
    }


    std::string last_line_of(const fs::path &path)
    {
      std::ifstream in(path);
      std::string   last;
      for (std::string line; std::getline(in, line);)
        if (!trimmed(line).empty())
          last = trimmed(line);
      return last;
    }


    /** The text of a Gmsh file that the Python package makes of a file of another format. */
    std::string converted(const std::string        &path,
                          const std::string        &file_name,
                          const unsigned int        dim,
                          std::vector<std::string> &notes)
    {
      const std::string     package = python_folder();
      const TemporaryFolder folder("perideal_mesh");
      if (package.empty() || folder.path.empty())
        refuse_file(file_name,
                    package.empty() ?
                      "is no Gmsh file (.msh), and the Python package that reads others was not "
                      "found beside the program." :
                      "is to be converted, and there can be no temporary folder for it (TMPDIR).");
      const fs::path out = folder.path / "mesh.msh", log = folder.path / "log",
                     said      = folder.path / "notes";
      const std::string python = python_program();
      const int         status =
        std::system(("PYTHONPATH=" + shell_word(package) + " " + shell_word(python) +
                     " -m perideal.meshes --dimension " + std::to_string(dim) + " " +
                     shell_word(path) + " " + shell_word(out.string()) + " > " +
                     shell_word(said.string()) + " 2> " + shell_word(log.string()) + " < /dev/null")
                      .c_str());
      constexpr int unknown = 127 << 8;
      if (status == unknown)
        refuse_file(file_name,
                    "is no Gmsh file (.msh), and '" + python +
                      "', which reads others, was not found. Install Python, or name one in "
                      "PERIDEAL_PYTHON.");
      std::string fault;
      std::string text = status == 0 ? read_file(out.string(), most_bytes_of_data, fault) : "";
      if (status != 0 || !fault.empty())
        {
          const std::string why = fault.empty() ? last_line_of(log) :
                                                  "the mesh made of it " + fault;
          refuse_file(file_name, why.empty() ? "cannot be converted." : why);
        }
      std::ifstream in(said);
      for (std::string line; std::getline(in, line);)
        notes.push_back(line);
      return text;
    }


    std::string place_text(const MshQuality::Place &p, const unsigned int dim)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        text += (d == 0 ? "(" : ", ") + rounded_text(p[d]);
      return text + ")";
    }


    /** "3 triangles and 4 quadrilaterals" */
    std::string text_of_kinds(const std::map<std::string, std::size_t> &kinds)
    {
      std::string text;
      for (const auto &[name, n] : kinds)
        text += (text.empty() ? "" : " and ") + std::to_string(n) + " " +
                (n == 1 ? name :
                 name == "tetrahedron" || name == "hexahedron" ?
                          name.substr(0, name.size() - 2) + "a" :
                          name + "s");
      return text;
    }


    /** Cells that are folded between their corners, which check_msh() looks at: of hexahedra and
     * wedges with twisted faces. In 2D convex cells are divided into such. */
    void check_quality(const MshMesh     &mesh,
                       const MshQuality  &quality,
                       const std::string &file_name,
                       const unsigned int dim)
    {
      constexpr double least = 1e-5;
      if (dim < 3 || quality.worst > least)
        return;
      const MshElement &cell = mesh.cells[quality.worst_cell];
      msh_error(file_name,
                cell.line,
                "the cell " + std::to_string(cell.number) + " is folded or flat" +
                  (mesh.n_divided > 0 ? " once it is divided" : " inside") + ", at " +
                  place_text(quality.worst_at, dim) + ": found that its edges span " +
                  rounded_text(quality.worst, 2) + " of a right corner there, expected more than " +
                  rounded_text(least) + ". Its faces are twisted, or its nodes nearly in a plane.");
    }


    /** What became of the cells, and what that means. */
    void note_cells(MshMesh                                  &mesh,
                    const std::string                        &file_name,
                    const std::map<std::string, std::size_t> &kinds,
                    const unsigned int                        dim)
    {
      const std::string quoted = "'" + file_name + "'";
      if (!mesh.touching.empty())
        mesh.notes.push_back(
          quoted + ": " + std::to_string(mesh.touching.size()) +
          " nodes lie on a node or an edge of cells that do not have them, the first at " +
          place_text(mesh.points[mesh.touching.front()], dim) +
          ": the body is apart there, as along a crack. If that is not meant, merge them (in Gmsh: "
          "'Coherence' before meshing, or 'RemoveDuplicateNodes').");
      if (dim == 1)
        return;
      const MshQuality quality = quality_of_msh(mesh, dim);
      check_quality(mesh, quality, file_name, dim);
      constexpr double poor     = 0.1;
      const double     unlike   = quality.median / quality.smallest;
      std::string      note     = quoted + ": ";
      const bool       is_worth = mesh.n_divided > 0 || quality.worst < poor;
      if (mesh.n_divided > 0)
        note += text_of_kinds(kinds) + " are divided into " + std::to_string(mesh.cells.size()) +
                " " + (dim == 2 ? "quadrilaterals" : "hexahedra") + ". ";
      note += "Edges have " + rounded_text(quality.smallest) + " to " +
              rounded_text(quality.largest) + ", half of them " + rounded_text(quality.median) +
              " or less; the shortest is at " + place_text(quality.smallest_at, dim);
      if (unlike > 2.)
        note += ", so that stable steps of explicit steppers are about " + rounded_text(unlike, 2) +
                " (motion) or " + rounded_text(unlike * unlike, 2) +
                " (diffusion) times shorter than on equal cells";
      note +=
        ". The worst corner spans " + rounded_text(quality.worst, 2) + " of a right one, at " +
        place_text(quality.worst_at, dim) +
        (quality.worst < poor ? ": stresses are inaccurate there; mesh that place better." : ".");
      if (is_worth)
        mesh.notes.push_back(note);
    }


    MshMesh parse_highest(const std::string &text, const std::string &file_name)
    {
      for (const unsigned int dim : {3, 2})
        try
          {
            return parse_msh(text, file_name, dim);
          }
        catch (const NoCells &)
          {}
      return parse_msh(text, file_name, 1);
    }


    MshMesh read_anew(const std::string &path,
                      const std::string &file_name,
                      const std::string &folder,
                      const unsigned int dim)
    {
      std::string              fault;
      std::vector<std::string> notes;
      std::string              text = read_file(path, most_bytes_of_data, fault);
      if (!fault.empty())
        refuse_file(file_name, fault + places_looked_at(file_name, folder));
      if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) // the mark of UTF-8
        text.erase(0, 3);
      if (!is_gmsh(text, path))
        text = converted(path, file_name, dim, notes);
      MshMesh mesh = dim == 0 ? parse_highest(text, file_name) : parse_msh(text, file_name, dim);
      text.clear();
      text.shrink_to_fit();
      check_msh(mesh, file_name, mesh.dim);
      std::map<std::string, std::size_t> kinds;
      for (const MshElement &cell : mesh.cells)
        ++kinds[msh_shape(mesh.dim, cell.n)];
      divide_msh(mesh, mesh.dim);
      mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
      for (std::string &note : mesh.notes)
        note = "'" + file_name + "': " + note;
      note_cells(mesh, file_name, kinds, mesh.dim);
      return mesh;
    }
  } // namespace


  std::string text_of_msh(const MshMesh &mesh, const unsigned int dim)
  {
    std::ostringstream text;
    text << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    if (!mesh.ids.empty())
      {
        text << "$PhysicalNames\n" << mesh.ids.size() << "\n";
        for (const auto &[key, id] : mesh.ids)
          text << key.first << " " << id << " \"" << key.second << "\"\n";
        text << "$EndPhysicalNames\n";
      }
    text << "$Nodes\n" << mesh.points.size() << "\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      text << i + 1 << " " << mesh.points[i][0] << " " << mesh.points[i][1] << " "
           << mesh.points[i][2] << "\n";
    text << "$EndNodes\n$Elements\n"
         << mesh.places.size() + mesh.sides.size() + mesh.interfaces.size() + mesh.cells.size()
         << "\n";
    constexpr int types[4] = {15, 1, 3, 5};
    std::size_t   number   = 0;
    for (const auto *const list : {&mesh.places, &mesh.sides, &mesh.interfaces, &mesh.cells})
      for (const MshElement &element : *list)
        {
          const unsigned int dimension = list == &mesh.cells  ? dim :
                                         list == &mesh.places ? 0 :
                                                                dim - 1;
          text << ++number << " " << types[dimension] << " 2 " << element.id << " " << element.id;
          for (unsigned int k = 0; k < element.n; ++k)
            text << " " << element.nodes[k] + 1;
          text << "\n";
        }
    text << "$EndElements\n";
    return text.str();
  }


  std::shared_ptr<const MshMesh> read_msh(const std::string &file_name,
                                          const std::string &folder,
                                          const unsigned int dim)
  {
    struct Last
    {
      std::string                    path;
      fs::file_time_type             time;
      std::uintmax_t                 size = 0;
      unsigned int                   dim  = 0;
      std::shared_ptr<const MshMesh> mesh;
    };
    static Last     last;
    std::string     path = file_name;
    std::error_code error;
    if (const auto beside = fs::path(folder) / file_name;
        !fs::exists(path, error) && fs::exists(beside, error))
      path = beside.string();
    Last now;
    now.path = fs::absolute(path, error).string();
    now.dim  = dim;
    now.time = fs::last_write_time(path, error);
    now.size = error ? 0 : fs::file_size(path, error);
    if (!error && last.mesh && last.path == now.path && last.time == now.time &&
        last.size == now.size && last.dim == dim)
      return last.mesh;
    last.mesh.reset();
    now.mesh = std::make_shared<MshMesh>(read_anew(path, file_name, folder, dim));
    last     = now;
    return now.mesh;
  }
} // namespace PeriDeal
