// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/operators/interface/term.h>
#include <perideal/operators/lattice/bond_form.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What bonds conduct: sum_j W_ij (u_i - u_j), by a BondForm. Vectors have the horizon-wide halo
   * of the nodes.
   */
  template <int dim>
  class BondTerm : public Term<dim>
  {
  public:
    using typename Term<dim>::At;
    using typename Term<dim>::Rows;

    /** Take the bonds, of as many nodes as the vectors of a layout have. Not collective. */
    void take(std::unique_ptr<BondForm>                                         of_bonds,
              const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout)
    {
      form         = std::move(of_bonds);
      communicator = layout->get_mpi_communicator();
      n_nodes      = layout->locally_owned_size();
      forget_sums();
    }

    /** Those of some owned nodes have changed. Not collective. */
    virtual void update_rows(const Rows &rows)
    {
      all_sums();
      form->update_rows(rows, sums.data());
      n_own_bonds = -1.;
    }

    /** The conductivities of all nodes have changed. Not collective. */
    virtual void update_conductivities()
    {
      sums.resize(n_nodes);
      form->update_conductivities(sums.data());
    }

    /** Sum of the W_ij of an owned node. */
    double sum_of(const unsigned int node) const
    {
      return all_sums()[node];
    }

    std::string name() const
    {
      return form->name();
    }

    void begin(const At &at, double &) const override
    {
      at.u.update_ghost_values();
    }

    void add(Vector &, const At &, const unsigned int, const unsigned int) const override
    {
      Assert(false, dealii::ExcMessage("Sums over bonds are the first term."));
    }

    void set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const override
    {
      form->apply(y.begin(), at.u.begin(), beyond(), finish);
      at.u.set_ghost_state(false);
    }

    void add_rows(Vector &diagonal, std::vector<double> &of_rows, const Rows &rows) const override
    {
      const std::vector<double> &all = all_sums();
      for (std::size_t k = 0; k < rows.size(); ++k)
        {
          diagonal.local_element(rows[k]) += all[rows[k]];
          of_rows[k] += 2. * all[rows[k]];
        }
    }

    void add_to(OperatorSize &size) const override
    {
      if (n_own_bonds < 0.)
        {
          std::vector<double> again(n_nodes);
          n_own_bonds = form->row_sums(again.data());
        }
      size.bonds = static_cast<unsigned long long>(
        std::llround(dealii::Utilities::MPI::sum(n_own_bonds, communicator)));
      size.nonzeros += dealii::Utilities::MPI::sum(form->n_stored(), communicator);
      size.memory += form->memory_consumption() + sums.capacity() * sizeof(double);
      size.form = form->name();
    }

  protected:
    /** Values of the fictitious nodes, null if there are none. */
    virtual const double *beyond() const
    {
      return nullptr;
    }

    /** Their memory is free until they are asked for again, which takes a sum over all bonds. */
    void forget_sums() const
    {
      std::vector<double>().swap(sums);
    }

  private:
    const std::vector<double> &all_sums() const
    {
      if (sums.empty())
        {
          sums.resize(n_nodes);
          n_own_bonds = form->row_sums(sums.data());
        }
      return sums;
    }

    std::unique_ptr<BondForm>   form;
    mutable std::vector<double> sums; // or empty
    unsigned int                n_nodes      = 0;
    MPI_Comm                    communicator = MPI_COMM_SELF;
    mutable double              n_own_bonds  = -1.; // of this process; negative: to be counted
  };
} // namespace PeriDeal
