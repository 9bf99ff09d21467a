"""Pictures and tables of navigation runs: the modules of leonav-report."""
