! SPDX-License-Identifier: LGPL-2.1-or-later
! Copyright (C) 2026 the PeriDeal authors
!
! A UMAT: J2 plasticity (von Mises) with linear isotropic and kinematic hardening, backward Euler,
! in space and in plane strain.
!
!     f = |xi| - sy - H kappa,   xi = s - alpha,   |xi| = sqrt(3/2 xi:xi),
!     d eps_p = 3/2 dk xi/|xi|,  d alpha = C dk xi/|xi|,  d kappa = dk.
!
! PROPS: Young's modulus, Poisson ratio, yield stress sy, H (isotropic), C (kinematic).
! STATEV: kappa, then the back stress alpha (NTENS numbers): 7 in space, 5 in plane strain.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props,  &
                nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt,      &
                kstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
   real(8) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl,             &
      ddsddt(ntens), drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp,      &
      dtemp, predef(1), dpred(1), props(nprops), coords(3), drot(3, 3), pnewdt, celent,             &
      dfgrd0(3, 3), dfgrd1(3, 3)

   real(8) :: bulk, shear, yield, isotropic, kinematic, over, grown, size, mean, xi(ntens), factor
   integer :: a, b

   if (ndi /= 3 .or. nprops < 5 .or. nstatv < 1 + ntens) then
      print *, 'user_law.f90 needs 5 properties, and NTENS + 1 states; not for plane stress'
      call xit
   end if
   bulk = props(1)/(3*(1 - 2*props(2)))
   shear = props(1)/(2*(1 + props(2)))
   yield = props(3)
   isotropic = props(4)
   kinematic = props(5)

   ! What the step would make without flow. Shear strains are engineering ones.
   ddsdde = 0
   ddsdde(1:3, 1:3) = bulk - 2*shear/3
   do a = 1, 3
      ddsdde(a, a) = bulk + 4*shear/3
   end do
   do a = 4, ntens
      ddsdde(a, a) = shear
   end do
   stress = stress + matmul(ddsdde, dstran)

   mean = sum(stress(1:3))/3
   xi = stress - statev(2:1 + ntens)
   xi(1:3) = xi(1:3) - mean
   size = sqrt(1.5d0*(sum(xi(1:3)**2) + 2*sum(xi(4:)**2)))
   over = size - yield - isotropic*statev(1)
   if (over > 0) then
      grown = over/(3*shear + isotropic + kinematic)
      stress = stress - 3*shear*grown/size*xi
      statev(1) = statev(1) + grown
      statev(2:1 + ntens) = statev(2:1 + ntens) + kinematic*grown/size*xi
      spd = spd + yield*grown

      ! The derivative of what has just been done.
      factor = 3*shear*grown/size
      ddsdde(1:3, 1:3) = ddsdde(1:3, 1:3) + factor*2*shear/3
      do a = 1, 3
         ddsdde(a, a) = ddsdde(a, a) - factor*2*shear
      end do
      do a = 4, ntens
         ddsdde(a, a) = ddsdde(a, a) - factor*shear
      end do
      factor = 3*shear/size**2*(3*shear/(3*shear + isotropic + kinematic) - factor)
      do b = 1, ntens
         do a = 1, ntens
            ddsdde(a, b) = ddsdde(a, b) - factor*xi(a)*xi(b)
         end do
      end do
   end if

   ! Stored: what is elastic, and what hardening keeps.
   xi = stress
   xi(1:3) = xi(1:3) - mean
   sse = mean**2/(2*bulk) + (sum(xi(1:3)**2) + 2*sum(xi(4:)**2))/(4*shear) + isotropic*statev(1)**2/2
   if (kinematic > 0) then
      sse = sse + 0.75d0/kinematic*(sum(statev(2:4)**2) + 2*sum(statev(5:1 + ntens)**2))
   end if
end subroutine umat
