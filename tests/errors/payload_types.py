import optixc as ox


@ox.program
def __miss__a():
    ox.set_payload_types(ox.PayloadTypeID.ID_0 | ox.PayloadTypeID.ID_1)


@ox.program
def __miss__b():
    if ox.get_ray_tmin() > 1.0:
        ox.set_payload_types(1)  # E[OX305]: must be the first statement


@ox.program
def __miss__c():
    ox.set_payload_types(ox.get_payload_0())  # E[OX305]: takes a constant
