from dexrepro.claims import Erratum

ERRATA = (Erratum("E90.01", "(90.1)", "slip", "a sign"),)
