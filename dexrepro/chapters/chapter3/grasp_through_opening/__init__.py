REQUIRES = ("torch",)
