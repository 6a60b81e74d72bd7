// name: findings-by-identity-factor
// kind: table
// description: Which findings are of data that tell of a factor of a person's identity (Article 4(1) GDPR), such as economic or location?
// param factor: string, name, location, economic, social or another factor; all of them if it is empty, default ""
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns factor: string, of Article 4(1); 'not stated' where the ontology says none of the kind, which may be any
// returns robot: string, name of the robot
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns article9: string, strongest verdict under Article 9(1) GDPR
// order: factor, robot, category, source, leak
MATCH (c:DataCategory)
UNWIND CASE WHEN size(coalesce(c.identity_factors, [])) = 0 THEN ['not stated'] ELSE c.identity_factors END AS factor
WITH c, factor WHERE $factor = '' OR factor IN [$factor, 'not stated']
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot
RETURN factor, f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak, c.article9 AS article9
ORDER BY factor, robot, category, source, leak
