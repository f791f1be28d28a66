! Forces between spheres in a sheared periodic cell, written from docs/physics.md alone: the code under test.
! n points from i to j, forces are those on a particle, velocities are laboratory ones, a stress is force (x) position over the volume.
module spheres
   use, intrinsic :: iso_fortran_env, only: dp => real64
   implicit none
   real(dp), parameter :: pi = acos(-1.0_dp)

   ! What the caller sets: cell vectors (columns), dU_i/dx_k, the fluid, the constants of the forces, the particles.
   real(dp) :: cell(3, 3), gradient(3, 3), volume, eta = 0, kT = 0, dt = 1
   real(dp) :: k_n = 0, k_t = 0, friction = 0, inner_gap = 0, outer_gap = 0
   logical :: periodic(3), arm_to_contact = .false., drag_torque = .false., rotation_corrected = .false., gaussian = .true.
   real(dp), allocatable :: x(:, :), u(:, :), w(:, :), a(:), rho(:)
   integer, allocatable :: history_i(:), history_j(:)
   real(dp), allocatable :: history(:, :)    ! displacement of the surface of i against that of j

   type pair                           ! i meets one image of j; the same i, j may meet through several images, and i = j
      integer :: i, j
      real(dp) :: d(3), r, n(3), gap   ! x_j - x_i of that image, its length and direction; the distance of the surfaces
      real(dp) :: du(3)                ! velocity of that image of j beyond that of i
   end type
   type(pair), allocatable :: pairs(:)

   type resistance                     ! the seven scalars of lubrication, eta included
      real(dp) :: x, y, b1, b2, c11, c12, c22
   end type

contains

   pure function cross(a, b) result(c)
      real(dp), intent(in) :: a(3), b(3)
      real(dp) :: c(3)
      c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
   end function

   pure function along(v, n)           ! the part of v along n
      real(dp), intent(in) :: v(3), n(3)
      real(dp) :: along(3)
      along = dot_product(v, n)*n
   end function

   pure function outer(a, b) result(c)
      real(dp), intent(in) :: a(3), b(3)
      real(dp) :: c(3, 3)
      c = spread(a, 2, 3)*spread(b, 1, 3)
   end function

   !> Every pair and image within reach of contact or lubrication, each once. Particles may lie outside the cell: images are counted
   !> from where they are, and an image shifted by `shift` moves faster by gradient times shift.
   subroutine find_pairs()
      real(dp) :: across(3, 3), reach, place(3), shift(3), margin(3)
      integer :: i, j, k, found, low(3), high(3), s1, s2, s3
      type(pair) :: p

      do k = 1, 3                      ! across(:, k) . x counts how many cell vectors k lie in x
         across(:, k) = cross(cell(:, mod(k, 3) + 1), cell(:, mod(k + 1, 3) + 1))
         across(:, k) = across(:, k)/dot_product(across(:, k), cell(:, k))
      end do
      if (allocated(pairs)) deallocate (pairs)
      allocate (pairs(64))
      found = 0
      do i = 1, size(a)
         do j = i, size(a)
            reach = (a(i) + a(j))*(1 + outer_gap/2)*(1 + 1e-12_dp)
            place = matmul(x(:, j) - x(:, i), across)
            margin = [(reach*norm2(across(:, k)), k=1, 3)]
            low = merge(ceiling(-place - margin), 0, periodic)
            high = merge(floor(-place + margin), 0, periodic)
            do s3 = low(3), high(3)
               do s2 = low(2), high(2)
                  do s1 = low(1), high(1)
                     if (i == j .and. (s3 < 0 .or. (s3 == 0 .and. (s2 < 0 .or. (s2 == 0 .and. s1 <= 0))))) cycle
                     shift = matmul(cell, real([s1, s2, s3], dp))
                     p%d = x(:, j) - x(:, i) + shift
                     p%r = norm2(p%d)
                     if (p%r > reach) cycle
                     p%i = i; p%j = j
                     p%n = p%d/p%r
                     p%gap = p%r - a(i) - a(j)
                     p%du = u(:, j) - u(:, i) + matmul(gradient, shift)
                     if (found == size(pairs)) pairs = [pairs, pairs]
                     found = found + 1
                     pairs(found) = p
                  end do
               end do
            end do
         end do
      end do
      pairs = pairs(:found)
   end subroutine

   !> A spring along n, and a tangential one: its displacement is turned into the tangent plane and cut to the Coulomb cap.
   subroutine contacts(f, t, stress_normal, stress_tangential)
      real(dp), intent(inout) :: f(:, :), t(:, :), stress_normal(3, 3), stress_tangential(3, 3)
      real(dp) :: s(3), normal(3), tangential(3), cap, arm
      integer :: k, m
      do k = 1, size(pairs)
         associate (p => pairs(k), i => pairs(k)%i, j => pairs(k)%j)
            if (p%gap >= 0) cycle
            s = 0
            do m = 1, size(history_i)
               if (history_i(m) == i .and. history_j(m) == j) s = history(:, m)
               if (history_i(m) == j .and. history_j(m) == i) s = -history(:, m)
            end do
            normal = k_n*p%gap*p%n     ! gap < 0: on i, away from j
            tangential = -k_t*(s - along(s, p%n))
            cap = friction*norm2(normal)
            if (norm2(tangential) > cap) tangential = tangential*(cap/norm2(tangential))
            arm = merge(p%r/(a(i) + a(j)), 1.0_dp, arm_to_contact)
            f(:, i) = f(:, i) + normal + tangential
            f(:, j) = f(:, j) - normal - tangential
            t(:, i) = t(:, i) + arm*a(i)*cross(p%n, tangential)
            t(:, j) = t(:, j) + arm*a(j)*cross(p%n, tangential)
            stress_normal = stress_normal + outer(normal, p%d)/volume
            stress_tangential = stress_tangential + outer(tangential, p%d)/volume
         end associate
      end do
   end subroutine

   function peculiar(i) result(c)      ! velocity beyond the flow's
      integer, intent(in) :: i
      real(dp) :: c(3)
      c = u(:, i) - matmul(gradient, x(:, i))
   end function

   function kinetic_stress() result(stress)
      real(dp) :: stress(3, 3)
      integer :: i
      stress = 0
      do i = 1, size(a)
         stress = stress - 4*pi/3*rho(i)*a(i)**3*outer(peculiar(i), peculiar(i))/volume
      end do
   end function

   subroutine drag(f, t, stress)
      real(dp), intent(inout) :: f(:, :), t(:, :), stress(3, 3)
      real(dp) :: vorticity(3)
      integer :: i
      vorticity = [gradient(3, 2) - gradient(2, 3), gradient(1, 3) - gradient(3, 1), gradient(2, 1) - gradient(1, 2)]
      do i = 1, size(a)
         f(:, i) = f(:, i) - 6*pi*eta*a(i)*peculiar(i)
         if (drag_torque) t(:, i) = t(:, i) + 8*pi*eta*a(i)**3*(vorticity/2 - w(:, i))
         stress = stress + 20*pi/3*eta*a(i)**3*(gradient + transpose(gradient))/2/volume
      end do
   end subroutine

   !> Jeffrey & Onishi's leading terms at xi = 2 gap/(a_i + a_j), not below the inner gap; false beyond the outer gap.
   logical function lubricated(p, z)
      type(pair), intent(in) :: p
      type(resistance), intent(out) :: z
      real(dp) :: a_i, a_j, beta, xi, log_xi, s
      a_i = a(p%i); a_j = a(p%j)
      beta = a_j/a_i
      xi = 2*p%gap/(a_i + a_j)
      lubricated = xi <= outer_gap
      if (.not. lubricated) return
      xi = max(xi, inner_gap)
      log_xi = log(1/xi)
      s = merge(p%r/(a_i + a_j), 1.0_dp, rotation_corrected)
      z%x = 6*pi*eta*a_i*(2*beta**2/(1 + beta)**3/xi + beta*(1 + 7*beta + beta**2)/(5*(1 + beta)**3)*log_xi)
      z%y = 6*pi*eta*a_i*4*beta*(2 + beta + 2*beta**2)/(15*(1 + beta)**3)*log_xi
      z%b1 = -4*pi*eta*a_i**2*beta*(4 + beta)/(5*(1 + beta)**2)*log_xi*s
      z%b2 = -4*pi*eta*a_j**2*(4*beta + 1)/(5*(1 + beta)**2)*log_xi*s
      z%c11 = 8*pi*eta*a_i**3*2*beta/(5*(1 + beta))*log_xi*s**2
      z%c12 = 8*pi*eta*a_i**3*beta**2/(10*(1 + beta))*log_xi*s**2
      z%c22 = 8*pi*eta*a_j**3*2/(5*(1 + beta))*log_xi*s**2
   end function

   subroutine lubrication(f, t, stress)
      real(dp), intent(inout) :: f(:, :), t(:, :), stress(3, 3)
      real(dp) :: force(3), squeezing(3), turning(3)
      type(resistance) :: z
      integer :: k
      do k = 1, size(pairs)
         if (.not. lubricated(pairs(k), z)) cycle
         associate (i => pairs(k)%i, j => pairs(k)%j, n => pairs(k)%n, du => pairs(k)%du)
            squeezing = along(du, n)
            force = z%x*squeezing + z%y*(du - squeezing) + cross(z%b1*w(:, i) + z%b2*w(:, j), n)
            f(:, i) = f(:, i) + force
            f(:, j) = f(:, j) - force
            turning = z%c11*w(:, i) + z%c12*w(:, j)
            t(:, i) = t(:, i) + z%b1*cross(du, n) - (turning - along(turning, n))
            turning = z%c12*w(:, i) + z%c22*w(:, j)
            t(:, j) = t(:, j) + z%b2*cross(du, n) - (turning - along(turning, n))
            stress = stress + outer(force, pairs(k)%d)/volume
         end associate
      end do
   end subroutine

   subroutine drag_noise(f, t)
      real(dp), intent(inout) :: f(:, :), t(:, :)
      real(dp) :: psi(6)
      integer :: i
      do i = 1, size(a)
         call draw(psi)
         f(:, i) = f(:, i) + sqrt(2*kT/dt*6*pi*eta*a(i))*psi(1:3)
         if (drag_torque) t(:, i) = t(:, i) + sqrt(2*kT/dt*8*pi*eta*a(i)**3)*psi(4:6)
      end do
   end subroutine

   subroutine lubrication_noise(f, t)
      real(dp), intent(inout) :: f(:, :), t(:, :)
      real(dp) :: theta(3), chi(3), squeezing(3), force(3), g
      type(resistance) :: z
      integer :: k
      g = sqrt(2*kT/dt)
      do k = 1, size(pairs)
         if (.not. lubricated(pairs(k), z)) cycle
         associate (i => pairs(k)%i, j => pairs(k)%j, n => pairs(k)%n)
            call draw(theta)
            call draw(chi)
            squeezing = along(theta, n)
            chi = chi - along(chi, n)
            force = g*(sqrt(z%x)*squeezing + sqrt(z%y)*(theta - squeezing))
            f(:, i) = f(:, i) + force
            f(:, j) = f(:, j) - force
            t(:, i) = t(:, i) + g*(z%b1/sqrt(z%y)*cross(theta, n) + sqrt(z%c11 - z%b1**2/z%y)*chi)
            t(:, j) = t(:, j) + g*(z%b2/sqrt(z%y)*cross(theta, n) - sqrt(z%c22 - z%b2**2/z%y)*chi)
         end associate
      end do
   end subroutine

   !> Independent numbers of mean 0 and variance 1: Gaussian (Box & Muller) or uniform.
   subroutine draw(v)
      real(dp), intent(out) :: v(:)
      real(dp) :: q(size(v))
      call random_number(v)
      call random_number(q)
      if (gaussian) then
         v = sqrt(-2*log(1 - v))*cos(2*pi*q)
      else
         v = sqrt(12.0_dp)*(v - 0.5_dp)
      end if
   end subroutine
end module
