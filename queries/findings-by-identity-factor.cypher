// name: findings-by-identity-factor
// kind: table
// description: Which findings are of data that tell of a factor of a person's identity (Article 4(1) GDPR), such as economic or location?
// param factor: identity factor, name, location, economic, social or another one; all of them if it is empty, default ""
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns factor: string, of Article 4(1); 'not stated' where the ontology says none of the kind, which may be any
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns article9: string, strongest verdict under Article 9(1) GDPR
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether the data only may tell of the factor asked for: a narrower kind does
// order: factor, robot, category, source, leak, leak_robot
MATCH (c:DataCategory)
WITH c, size(coalesce(c.identity_factors, [])) = 0 AS unknown
WITH c, unknown, $factor <> '' AND NOT unknown AND NOT $factor IN c.identity_factors
     AND EXISTS { (c)<-[:BROADER*1..]-(n) WHERE size(coalesce(n.identity_factors, [])) = 0
                                             OR $factor IN n.identity_factors } AS may_be
UNWIND CASE WHEN unknown THEN ['not stated'] WHEN may_be THEN [$factor] ELSE c.identity_factors END AS factor
WITH c, factor, may_be WHERE $factor = '' OR factor IN [$factor, 'not stated']
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
RETURN factor, f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak,
       c.article9 AS article9, f.leak_robot AS leak_robot, may_be
ORDER BY factor, robot, category, source, leak, leak_robot
