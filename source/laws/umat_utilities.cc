// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/laws/umat_utilities.h>
#include <perideal/scene/user_library.h>

#include <cmath>

namespace PeriDeal
{
  namespace
  {
    using Symmetric = dealii::SymmetricTensor<2, 3>;

    /** Shear of lists. */
    constexpr unsigned int sheared[3][2] = {{0, 1}, {0, 2}, {1, 2}};


    /** @param lstr 2: a strain */
    Symmetric tensor_of(const double *const list, const int lstr, const int ndi, const int nshr)
    {
      Symmetric tensor;
      for (int k = 0; k < ndi; ++k)
        tensor[k][k] = list[k];
      for (int k = 0; k < nshr; ++k)
        tensor[sheared[k][0]][sheared[k][1]] = (lstr == 2 ? 0.5 : 1.) * list[ndi + k];
      return tensor;
    }
  } // namespace
} // namespace PeriDeal


using namespace PeriDeal;


void sinv_(const double *const stress,
           double *const       sinv1,
           double *const       sinv2,
           const int *const    ndi,
           const int *const    nshr)
{
  const Symmetric s = tensor_of(stress, 1, *ndi, *nshr);
  *sinv1            = dealii::trace(s) / 3.;
  *sinv2            = std::sqrt(1.5) * dealii::deviator(s).norm();
}


void sprinc_(const double *const s,
             double *const       ps,
             const int *const    lstr,
             const int *const    ndi,
             const int *const    nshr)
{
  const auto values = dealii::eigenvalues(tensor_of(s, *lstr, *ndi, *nshr));
  for (unsigned int k = 0; k < 3; ++k)
    ps[k] = values[k];
}


void sprind_(const double *const s,
             double *const       ps,
             double *const       an,
             const int *const    lstr,
             const int *const    ndi,
             const int *const    nshr)
{
  const auto pairs = dealii::eigenvectors(tensor_of(s, *lstr, *ndi, *nshr),
                                          dealii::SymmetricTensorEigenvectorMethod::jacobi);
  for (unsigned int k = 0; k < 3; ++k)
    {
      ps[k] = pairs[k].first;
      for (unsigned int d = 0; d < 3; ++d)
        an[k + 3 * d] = pairs[k].second[d];
    }
}


void rotsig_(const double *const s,
             const double *const r,
             double *const       sprime,
             const int *const    lstr,
             const int *const    ndi,
             const int *const    nshr)
{
  dealii::Tensor<2, 3> R;
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b)
      R[a][b] = r[a + 3 * b];
  const dealii::Tensor<2, 3> turned = R * tensor_of(s, *lstr, *ndi, *nshr) * dealii::transpose(R);
  for (int k = 0; k < *ndi; ++k)
    sprime[k] = turned[k][k];
  for (int k = 0; k < *nshr; ++k)
    sprime[*ndi + k] = (*lstr == 2 ? 2. : 1.) * turned[sheared[k][0]][sheared[k][1]];
}


void xit_()
{
  leave_user_library();
}
