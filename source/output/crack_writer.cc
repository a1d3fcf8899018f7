// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <perideal/output/crack_writer.h>

#include <cstdint>
#include <sstream>

#include "checksum.h"
#include "exchange_of_first.h"

namespace PeriDeal
{
  namespace
  {
    /** VTK's numbers of kinds of cells: 3 is a line, 7 a polygon. */
    std::string vtu_of(const NewCracks &cracks)
    {
      std::ostringstream points, connectivity, offsets, types, numbers;
      points.precision(17);
      unsigned int n = 0, number = 0;
      for (const auto &corners : cracks.pieces)
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
      for (const auto &[of, values] : cracks.numbers)
        {
          std::ostringstream list;
          list.precision(17);
          for (const double value : values)
            list << value << ' ';
          array("type=\"Float64\" Name=\"" + of + "\"", list);
        }
      out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
      return out.str();
    }
  } // namespace


  CrackWriter::CrackWriter(ResultFolder &folder, const std::string &name)
    : folder(folder)
    , name(name)
  {}


  void CrackWriter::write(const NewCracks &cracks, const double time)
  {
    if (cracks.pieces.empty() || !folder.writes() || folder.failed())
      return;
    const auto file = [&](const unsigned int number) {
      return "fields/" + name + "_" + dealii::Utilities::int_to_string(number, 4) + ".vtu";
    };
    const std::string   text = vtu_of(cracks);
    const std::uint64_t sum  = checksum(text.data(), text.size());
    if (n_files == 0 || sum != last)
      {
        last = sum;
        folder.write(file(n_files++), text);
      }
    records.emplace_back(time, file(n_files - 1));
    std::ostringstream pvd;
    dealii::DataOutBase::write_pvd_record(pvd, records);
    if (!folder.failed())
      folder.write(name + ".pvd", pvd.str());
  }


  void CrackWriter::exchange(Archive &archive)
  {
    auto state = nlohmann::ordered_json::array({last, records, n_files});
    exchange_of_first(archive, name, state, folder.processes());
    if (state[0].is_number()) // earlier checkpoints have the pieces themselves
      state[0].get_to(last);
    state[1].get_to(records);
    state[2].get_to(n_files);
  }
} // namespace PeriDeal
