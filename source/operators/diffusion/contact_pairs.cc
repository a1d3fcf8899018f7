// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/diffusion/contact_pairs.h>
#include <perideal/scene/crack_geometry.h>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** An unknown on a face along a crack, as seen from the cell there. */
    template <int dim>
    struct OnFace
    {
      Point<dim>              face, place, cell; // middles of face and cell
      types::global_dof_index dof;
      double                  area; // integral of the shape function over the face
      double                  size; // of the face

      template <class Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &face &place &cell &dof &area &size;
      }
    };


    /** Those of the cells of this process. */
    template <int dim>
    std::vector<OnFace<dim>> unknowns_on_cracks(const DoFHandler<dim> &dofs)
    {
      std::vector<OnFace<dim>>             found;
      const FiniteElement<dim>            &fe = dofs.get_fe();
      const MappingQ1<dim>                 mapping;
      FEFaceValues<dim>                    values(mapping,
                               fe,
                               QGauss<dim - 1>(fe.degree + 1),
                               update_values | update_JxW_values);
      std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->is_locally_owned() && cell->face(f)->at_boundary() &&
              cell->face(f)->boundary_id() == crack_boundary_id)
            {
              values.reinit(cell, f);
              cell->get_dof_indices(indices);
              for (unsigned int i = 0; i < indices.size(); ++i)
                if (fe.has_support_on_face(i, f))
                  {
                    double area = 0.;
                    for (const unsigned int q : values.quadrature_point_indices())
                      area += values.shape_value(i, q) * values.JxW(q);
                    found.push_back(
                      {cell->face(f)->center(),
                       mapping.transform_unit_to_real_cell(cell, fe.unit_support_point(i)),
                       cell->center(),
                       indices[i],
                       area,
                       cell->face(f)->diameter()});
                  }
            }
      return found;
    }
  } // namespace


  template <int dim>
  std::vector<ContactPair> contact_pairs([[maybe_unused]] const DoFHandler<dim> &dofs,
                                         [[maybe_unused]] const Cracks<dim>     &cracks)
  {
    std::vector<ContactPair> pairs;
    if constexpr (dim > 1)
      {
        if (!cracks.double_nodes() || !(cracks.contact_conductance > 0.))
          return pairs;
        std::vector<OnFace<dim>> all;
        for (const auto &of_process :
             Utilities::MPI::all_gather(dofs.get_communicator(), unknowns_on_cracks(dofs)))
          all.insert(all.end(), of_process.begin(), of_process.end());
        using Entry = std::pair<BoundingBox<dim>, unsigned int>;
        std::vector<Entry> boxes;
        for (unsigned int k = 0; k < all.size(); ++k)
          boxes.emplace_back(BoundingBox<dim>(std::make_pair(all[k].face, all[k].face)), k);
        const auto tree       = pack_rtree(boxes);
        const auto geometries = make_crack_geometries(cracks.pieces(0.));
        for (const OnFace<dim> &one : all)
          {
            if (!dofs.locally_owned_dofs().is_element(one.dof))
              continue;
            const double     same = 1e-6 * one.size;
            BoundingBox<dim> near(std::make_pair(one.face, one.face));
            near.extend(same);
            std::vector<Entry> there;
            tree.query(boost::geometry::index::intersects(near), std::back_inserter(there));
            for (const auto &[box, k] : there)
              if (const OnFace<dim> &other = all[k]; other.dof != one.dof &&
                                                     other.place.distance(one.place) < same &&
                                                     other.cell.distance(one.cell) > same)
                {
                  ContactPair pair{one.dof, other.dof, cracks.contact_conductance * one.area, 0, 1};
                  for (const CrackGeometry<dim> &crack : geometries)
                    if (crack.contains(one.face))
                      {
                        pair.crack = crack.crack;
                        pair.side  = crack.signed_distance(one.cell) > 0. ? 1 : -1;
                        break;
                      }
                  pairs.push_back(pair);
                }
          }
      }
    return pairs;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(contact_pairs);
} // namespace PeriDeal
