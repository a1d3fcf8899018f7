// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <perideal/output/crack_writer.h>

#include <sstream>

#include "exchange_of_first.h"

namespace PeriDeal
{
  namespace
  {
    /** VTK's numbers of kinds of cells: 3 is a line, 7 a polygon. */
    std::string vtu_of(const CrackCorners &pieces)
    {
      std::ostringstream points, connectivity, offsets, types, numbers;
      points.precision(17);
      unsigned int n = 0, number = 0;
      for (const auto &corners : pieces)
        {
          for (const auto &p : corners)
            {
              points << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
              connectivity << n++ << ' ';
            }
          offsets << n << ' ';
          types << (corners.size() == 2 ? 3 : 7) << ' ';
          numbers << ++number << ' ';
        }
      std::ostringstream out;
      const auto array = [&](const std::string &attributes, const std::ostringstream &values) {
        out << "<DataArray " << attributes << " format=\"ascii\">\n"
            << values.str() << "\n</DataArray>\n";
      };
      out
        << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        << "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << number
        << "\">\n<Points>\n";
      array("type=\"Float64\" NumberOfComponents=\"3\"", points);
      out << "</Points>\n<Cells>\n";
      array("type=\"Int32\" Name=\"connectivity\"", connectivity);
      array("type=\"Int32\" Name=\"offsets\"", offsets);
      array("type=\"UInt8\" Name=\"types\"", types);
      out << "</Cells>\n<CellData Scalars=\"piece\">\n";
      array("type=\"Int32\" Name=\"piece\"", numbers);
      out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
      return out.str();
    }
  } // namespace


  CrackWriter::CrackWriter(ResultFolder &folder)
    : folder(folder)
  {}


  void CrackWriter::write(const CrackCorners &pieces, const double time)
  {
    if (pieces.empty() || !folder.writes() || folder.failed())
      return;
    if (pieces != last)
      {
        last = pieces;
        folder.write("fields/cracks_" + dealii::Utilities::int_to_string(n_files++, 4) + ".vtu",
                     vtu_of(pieces));
      }
    records.emplace_back(time,
                         "fields/cracks_" + dealii::Utilities::int_to_string(n_files - 1, 4) +
                           ".vtu");
    std::ostringstream pvd;
    dealii::DataOutBase::write_pvd_record(pvd, records);
    if (!folder.failed())
      folder.write("cracks.pvd", pvd.str());
  }


  void CrackWriter::exchange(Archive &archive)
  {
    auto state = nlohmann::ordered_json::array({last, records, n_files});
    exchange_of_first(archive, "cracks", state, folder.processes());
    state[0].get_to(last);
    state[1].get_to(records);
    state[2].get_to(n_files);
  }
} // namespace PeriDeal
