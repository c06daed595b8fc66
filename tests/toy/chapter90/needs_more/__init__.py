REQUIRES = ("no_such_package",)
