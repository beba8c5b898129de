# Debian packages.
#>   package            Debian packages for any machine of the architecture -> workflows/out/package/
#>   test-package       installs them on a bare Debian 12, runs the README's tour and a case on two processes there,
#>                      removes them; takes minutes, needs root and debootstrap

.PHONY: package
package: provision
	@$(call build_preset,package)
	@rm -f ../build/package/packages/*.deb
	@cd ../build/package && cpack -B packages > packages.log || { cat packages.log; exit 1; }
	@mkdir -p $(OUT)/package && rm -f $(OUT)/package/*.deb && cp ../build/package/packages/*.deb $(OUT)/package/
	@ls $(OUT)/package/*.deb
	@ls $(OUT)/package/suffuse-mpi_*.deb > /dev/null 2>&1 || echo 'package: there is no suffuse-mpi, which needs MPI and PETSc'

.PHONY: test-package
test-package: package
	tests/package.sh $(OUT)/package
