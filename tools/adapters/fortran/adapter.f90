! ADAPTER CASE_DIR OUT_DIR: the spheres of spheres.f90 as a candidate of the gate at level A, from the plain text of docs/adapter.md.
program adapter
   use, intrinsic :: iso_fortran_env, only: int64
   use spheres
   implicit none
   ! The keys of a scene that are understood, with # for numbers. Any other may change the question, and is refused.
   character(*), parameter :: known(*) = [character(60) :: '$schema', 'about', 'seed', 'realisation', 'dimensions', &
      'fluid.viscosity', 'fluid.kT', 'start.time', 'dynamics.verlet.dt', 'run.steps', 'box.lengths.count', 'box.lengths.#', &
      'box.cell.count', 'box.cell.#.count', 'box.cell.#.#', 'box.periodic.count', 'box.periodic.#', 'shear.count', &
      'shear.#.flow', 'shear.#.gradient', 'shear.#.rate', 'species.count', 'species.#.name', 'species.#.radius', &
      'species.#.density', 'forces.contact.normal_stiffness', 'forces.contact.tangential_stiffness', &
      'forces.contact.friction', 'forces.contact.lever', 'forces.contact.law', 'forces.drag.torque', &
      'forces.lubrication.inner_gap', 'forces.lubrication.outer_gap', 'forces.lubrication.rotation_correction', &
      'forces.drag_noise.distribution', 'forces.lubrication_noise.distribution']
   integer, parameter :: wide = 200
   character(wide), allocatable :: names(:), values(:)          ! the lines of case.txt
   integer, allocatable :: state(:), species(:), contact_state(:), contact_i(:), contact_j(:)
   real(dp), allocatable :: table(:, :), displacement(:, :), radius(:), density(:)
   character(wide) :: folder, answer, key, force
   integer :: i, k, forces_unit, stress_unit

   call get_command_argument(1, folder)
   call get_command_argument(2, answer)
   call read_case()
   if (all(['forces', 'noise '] /= word('case.protocol'))) call refuse('protocol '//trim(word('case.protocol')))
   do k = 1, size(names)
      key = pattern(names(k)(7:))      ! without "scene."
      if (index(names(k), 'scene.') == 1 .and. .not. any(known == key)) call refuse(trim(names(k)))
   end do
   if (number('scene.dimensions', 3.0_dp) < 3) call refuse('discs')
   if (word('scene.forces.contact.law') /= '' .and. word('scene.forces.contact.law') /= 'plain') call refuse('other friction laws')
   call set_constants()
   call read_tables()
   if (word('case.protocol') == 'forces') then
      call answer_forces()
   else
      call answer_noise()
   end if

contains

   !> Exit code 77, "this I do not have"; the last line printed is the reason.
   subroutine refuse(what)
      character(*), intent(in) :: what
      print '(2a)', 'the Fortran spheres do not have ', what
      stop 77, quiet=.true.
   end subroutine

   subroutine read_case()
      character(wide) :: name, value
      integer :: unit, status, pass, lines
      open (newunit=unit, file=trim(folder)//'/case.txt', status='old', action='read')
      do pass = 1, 2                   ! count, then keep
         if (pass == 2) allocate (names(lines), values(lines))
         rewind (unit)
         lines = 0
         do
            read (unit, *, iostat=status) name, value
            if (status /= 0) exit
            lines = lines + 1
            if (pass == 2) names(lines) = name
            if (pass == 2) values(lines) = value
         end do
      end do
      close (unit)
   end subroutine

   !> The value of a name; blank if it is not there.
   function word(name)
      character(*), intent(in) :: name
      character(wide) :: word
      integer :: line
      line = findloc(names, name, 1)
      word = ''
      if (line > 0) word = values(line)
   end function

   real(dp) function number(name, otherwise)
      character(*), intent(in) :: name
      real(dp), intent(in), optional :: otherwise
      character(wide) :: value
      value = word(name)
      if (value /= '') then
         read (value, *) number
      else if (present(otherwise)) then
         number = otherwise
      else
         print '(3a)', 'case.txt has no ', name
         error stop 1
      end if
   end function

   function text(k)
      integer, intent(in) :: k
      character(:), allocatable :: text
      character(12) :: buffer
      write (buffer, '(i0)') k
      text = trim(buffer)
   end function

   !> A name with # for each of its numbers: species.2.radius is species.#.radius.
   function pattern(name)
      character(*), intent(in) :: name
      character(wide) :: pattern
      integer :: k
      pattern = name
      do k = 0, 9
         do while (index(pattern, '.'//text(k)) > 0)
            i = index(pattern, '.'//text(k))
            pattern = pattern(:i)//'#'//pattern(i + 1 + verify(pattern(i + 1:), '0123456789') - 1:)
         end do
      end do
   end function

   subroutine set_constants()
      do k = 1, 3
         do i = 1, 3
            cell(i, k) = number('cell.'//text(k)//'.'//text(i))
            gradient(i, k) = number('gradient.'//text(i)//'.'//text(k))
         end do
         periodic(k) = word('scene.box.periodic.'//text(k)) == 'true'
      end do
      volume = number('volume')
      eta = number('scene.fluid.viscosity', 0.0_dp)
      kT = number('scene.fluid.kT', 0.0_dp)
      dt = number('scene.dynamics.verlet.dt')
      k_n = number('scene.forces.contact.normal_stiffness', 0.0_dp)
      k_t = number('scene.forces.contact.tangential_stiffness', 0.0_dp)
      friction = number('scene.forces.contact.friction', 0.0_dp)
      inner_gap = number('scene.forces.lubrication.inner_gap', 0.0_dp)
      outer_gap = number('scene.forces.lubrication.outer_gap', 0.0_dp)
      arm_to_contact = word('scene.forces.contact.lever') == 'contact'
      rotation_corrected = word('scene.forces.lubrication.rotation_correction') == 'exact'
      drag_torque = word('scene.forces.drag.torque') == 'true'
      radius = [(number('scene.species.'//text(k)//'.radius'), k=1, nint(number('scene.species.count')))]
      density = [(number('scene.species.'//text(k)//'.density'), k=1, size(radius))]
   end subroutine

   subroutine read_tables()
      integer :: unit, rows, id
      logical :: there
      open (newunit=unit, file=trim(folder)//'/states.txt', status='old', action='read')
      read (unit, *) rows
      allocate (state(rows), species(rows), table(9, rows))
      read (unit, *) (state(i), id, species(i), table(:, i), i=1, rows)
      close (unit)
      rows = 0
      inquire (file=trim(folder)//'/contacts.txt', exist=there)
      if (there) open (newunit=unit, file=trim(folder)//'/contacts.txt', status='old', action='read')
      if (there) read (unit, *) rows
      allocate (contact_state(rows), contact_i(rows), contact_j(rows), displacement(3, rows))
      if (there) read (unit, *) (contact_state(i), contact_i(i), contact_j(i), displacement(:, i), i=1, rows)
   end subroutine

   !> Hands the particles and contacts of one state to the code under test; false after the last state.
   logical function take(which)
      integer, intent(in) :: which
      integer, allocatable :: rows(:)
      rows = pack([(i, i=1, size(state))], state == which)
      take = size(rows) > 0
      if (.not. take) return
      x = table(1:3, rows)
      u = table(4:6, rows)
      w = table(7:9, rows)
      a = radius(species(rows))
      rho = density(species(rows))
      rows = pack([(i, i=1, size(contact_state))], contact_state == which)
      history_i = contact_i(rows)
      history_j = contact_j(rows)
      history = displacement(:, rows)
      call find_pairs()
   end function

   subroutine answer_forces()
      integer :: which
      real(dp), allocatable :: f(:, :), t(:, :), total_f(:, :), total_t(:, :)
      real(dp) :: stress(3, 3), tangential(3, 3)
      open (newunit=forces_unit, file=trim(answer)//'/forces.txt', action='write')
      open (newunit=stress_unit, file=trim(answer)//'/stress.txt', action='write')
      which = 0
      do while (take(which))
         allocate (total_f(3, size(a)), source=0.0_dp)
         total_t = total_f
         do k = 1, nint(number('forces.count'))
            allocate (f(3, size(a)), source=0.0_dp)
            t = f
            stress = 0
            tangential = 0
            select case (word('forces.'//text(k)))
            case ('contact')
               call contacts(f, t, stress, tangential)
               call write_forces(which, 'contact', f, t)
               call write_stress(which, 'contact_normal', stress)
               if (friction > 0) call write_stress(which, 'contact_tangential', tangential)
            case ('drag')
               call drag(f, t, stress)
               call write_forces(which, 'drag', f, t)
               call write_stress(which, 'drag', stress)
            case ('lubrication')
               call lubrication(f, t, stress)
               call write_forces(which, 'lubrication', f, t)
               call write_stress(which, 'lubrication', stress)
            end select                 ! noise is not asked for here
            total_f = total_f + f
            total_t = total_t + t
            deallocate (f)
         end do
         call write_forces(which, 'total', total_f, total_t)
         call write_stress(which, 'kinetic', kinetic_stress())
         deallocate (total_f)
         which = which + 1
      end do
   end subroutine

   subroutine write_forces(which, force, f, t)
      integer, intent(in) :: which
      character(*), intent(in) :: force
      real(dp), intent(in) :: f(:, :), t(:, :)
      do i = 1, size(a)
         write (forces_unit, '(i0, 1x, a, 1x, i0, 6es25.16e3)') which, force, i, f(:, i), t(:, i)
      end do
   end subroutine

   subroutine write_stress(which, origin, stress)
      integer, intent(in) :: which
      character(*), intent(in) :: origin
      real(dp), intent(in) :: stress(3, 3)
      write (stress_unit, '(i0, 1x, a, 9es25.16e3)') which, origin, transpose(stress)    ! row by row: xx, xy, xz, yx, ...
   end subroutine

   !> One file in NumPy's format for each noise force of the scene: the shape, then the draws on the first state.
   subroutine answer_noise()
      real(dp), allocatable :: f(:, :), t(:, :)
      character(118) :: header
      integer :: unit, draws, d
      if (.not. take(0)) call refuse('a question without particles')
      call seed_generator(nint(number('scene.seed'), int64), nint(number('scene.realisation', 0.0_dp)))
      draws = nint(number('case.draws'))
      write (header, '(a, 2(i0, a))') "{'descr': '<f8', 'fortran_order': False, 'shape': (", draws, ', ', size(a), ', 6), }'
      header(118:118) = new_line('a')
      do k = 1, nint(number('forces.count'))
         force = word('forces.'//text(k))
         if (index(force, 'noise') == 0) cycle
         gaussian = word('scene.forces.'//trim(force)//'.distribution') == 'gaussian'
         open (newunit=unit, file=trim(answer)//'/noise_'//trim(force)//'.npy', access='stream', form='unformatted')
         write (unit) char(147), 'NUMPY', char(1), char(0), char(len(header)), char(0), header
         do d = 1, draws
            allocate (f(3, size(a)), source=0.0_dp)
            t = f
            if (force == 'drag_noise') call drag_noise(f, t)
            if (force == 'lubrication_noise') call lubrication_noise(f, t)
            write (unit) (f(:, i), t(:, i), i=1, size(a))
            deallocate (f)
         end do
         close (unit)
      end do
   end subroutine

   !> Other seeds and realisations give other numbers.
   subroutine seed_generator(seed, realisation)
      integer(int64), intent(in) :: seed
      integer, intent(in) :: realisation
      integer, allocatable :: start(:)
      call random_seed(size=k)
      start = [(int(modulo((i + realisation)*seed, 2147483647_int64)), i=1, k)]
      call random_seed(put=start)
   end subroutine
end program
